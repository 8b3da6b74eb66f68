#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace pillarfield {

struct ChildLimits {
  unsigned processor_s = 2;
  std::chrono::milliseconds time{10'000};           ///< wall time
  std::size_t memory_bytes = std::size_t{1} << 30;  ///< beyond the parent's address space
};

struct ChildEnd {
  std::string text;       ///< returned by the function
  bool returned = false;  ///< the function returned, and `text` is complete
  bool in_time = true;    ///< the child was not ended by a time limit
  int signal = 0;         ///< that ended the child; 0: none, or unknown
};

/// Runs `work` in a forked child process and waits for its end. The child discards its output, has
/// default signal actions, and closes inherited files. `work` must not throw, and must take no lock
/// that another thread may hold; it may use the heap. `do_fork` calls fork() while holding such a
/// lock, or is fork() itself. Throws Error at `where` if the child cannot be started.
[[nodiscard]] ChildEnd run_in_child(const std::string& where, const ChildLimits& limits,
                                    const std::function<int()>& do_fork,
                                    const std::function<std::string()>& work);

}  // namespace pillarfield
