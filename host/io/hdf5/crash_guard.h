#pragma once

#include <array>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <limits>
#include <string>

namespace pillarfield::hdf5 {

/// Names the file if the HDF5 library crashes or loops on it: while a guard exists, a fatal signal
/// in this thread, or 2 s of its processor time and one more for each 16 MiB of `bytes` that are
/// read, end the process with exit status 1 and one line on standard error. Damaged files do both
/// to HDF5 1.10. With kNoLimit it has no limit of time and holds guards with one: crashes of our
/// own code between calls of HDF5, which may have damaged memory. Otherwise a guard within another,
/// or of a trusted file, does nothing. Signals in other threads, and later ones, have their former
/// actions.
class CrashGuard {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();
  explicit CrashGuard(const std::filesystem::path& file, bool trusted = false, double bytes = 0);
  ~CrashGuard();
  CrashGuard(const CrashGuard&) = delete;
  CrashGuard& operator=(const CrashGuard&) = delete;

 private:
  static void handle_signals();
  static void end_process(int signal, siginfo_t* facts, void* context);

  std::string crashed_;  ///< lines to print
  std::string late_;
  bool is_active_ = false;
  const CrashGuard* former_ = nullptr;
  timer_t timer_ = {};
  bool has_timer_ = false;
  stack_t stack_before_ = {};
  std::array<char, 1 << 15> stack_;  ///< of the handler: HDF5 may have used up the thread's
};

}  // namespace pillarfield::hdf5
