#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace pillarfield {

/// What a child process may take.
struct ChildLimits {
  unsigned processor_s = 2;
  std::chrono::milliseconds time{10'000};           ///< waiting for a disk included
  std::size_t memory_bytes = std::size_t{1} << 30;  ///< beyond what the parent has mapped
};

/// How a child process ended.
struct ChildEnd {
  std::string text;       ///< what the function returned
  bool returned = false;  ///< it returned, and `text` is complete
  bool in_time = true;    ///< it was not ended for the sake of its limits of time
  int signal = 0;         ///< that ended it, 0 where it is not known
};

/// Runs `work` in a child process, which is a copy of this one with no other thread, and waits for
/// its end. Nothing that it prints is seen, its signals have their default actions, and files that
/// are open here are closed there. `work` must not throw, and must take no lock that another thread
/// may hold; the heap may be used. Throws Error, its place being `where`, where there can be no
/// child. `do_fork` calls fork() under such a lock, or is fork() itself.
[[nodiscard]] ChildEnd run_in_child(const std::string& where, const ChildLimits& limits,
                                    const std::function<int()>& do_fork,
                                    const std::function<std::string()>& work);

}  // namespace pillarfield
