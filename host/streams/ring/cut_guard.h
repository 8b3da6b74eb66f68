#pragma once

#include <csignal>
#include <cstddef>
#include <span>

namespace pillarfield {

/// Lets a thread survive that another program shortens the shared memory which it writes, instead
/// of SIGBUS, which ends the process: the memory is replaced by private memory at its first access
/// beyond the new end. Signals of other memory go to the handler that was there before.
class CutGuard {
 public:
  /// Installs the handler of the process.
  CutGuard();
  ~CutGuard() { end(); }
  CutGuard(const CutGuard&) = delete;
  CutGuard& operator=(const CutGuard&) = delete;

  /// The mapped memory; not between begin() and end() of another guard of this thread.
  void watch(std::span<std::byte> memory) { memory_ = memory; }

  /// From begin() to end() this thread may access the memory.
  void begin();
  void end();

  /// Whether the memory was replaced.
  [[nodiscard]] bool is_cut() const { return is_cut_ != 0; }

 private:
  static void on_bus_error(int signal, siginfo_t* info, void* context);
  bool replace(const void* accessed);

  std::span<std::byte> memory_;
  volatile std::sig_atomic_t is_cut_ = 0;
};

}  // namespace pillarfield
