#pragma once

#include <array>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <string>

namespace pillarfield::hdf5 {

/// Names the file if the HDF5 library crashes or loops on it: while a guard exists, a fatal signal
/// in this thread, or 2 s of its processor time, end the process with exit status 1 and one line on
/// standard error. Damaged files do both to HDF5 1.10. A guard of a trusted file, or within
/// another, does nothing, and signals in other threads have their former actions. Where a signal
/// has none and no guard exists, as when HDF5 has damaged memory, the line names the file that was
/// read last, and the signal stays, but for exit_after_crashes().
class CrashGuard {
 public:
  explicit CrashGuard(const std::filesystem::path& file, bool trusted = false);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static void handle_signals();
  static void end_process(int signal, siginfo_t* facts, void* context);

  std::string crashed_;  ///< lines to print
  std::string late_;
  bool is_outer_ = false;
  timer_t timer_ = {};
  bool has_timer_ = false;
  stack_t stack_before_ = {};
  std::array<char, 1 << 15> stack_;  ///< of the handler: HDF5 may have used up the thread's
};

}  // namespace pillarfield::hdf5
