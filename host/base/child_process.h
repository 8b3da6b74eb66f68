#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace pillarfield {

struct ChildLimits {
  unsigned processor_s = 2;
  std::chrono::milliseconds time{10'000};           ///< wall time
  std::size_t memory_bytes = std::size_t{1} << 30;  ///< beyond the parent's address space
};

struct ChildEnd {
  /// `late`: at the limit of wall time. `interrupted`: is_interrupted() ended the wait.
  enum class Reason : std::uint8_t { returned, died, late, interrupted };
  Reason reason = Reason::died;
  std::string text;  ///< returned by the function
  int signal = 0;    ///< that ended the child, SIGXCPU at the limit of processor time; 0: unknown
  std::chrono::microseconds processor_time{0};  ///< that the child took; 0: unknown
};

/// Runs `work` in a forked child process and waits for its end. The child discards its output, has
/// default signal actions, and closes inherited files but `input`. `work` must not throw, and must
/// take no lock that another thread may hold; it may use the heap. `do_fork` calls fork() while
/// holding such a lock, or is fork() itself. Throws Error at `where` if the child cannot be
/// started.
[[nodiscard]] ChildEnd run_in_child(const std::string& where, const ChildLimits& limits, int input,
                                    const std::function<int()>& do_fork,
                                    const std::function<std::string()>& work);

}  // namespace pillarfield
