#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace pillarfield {

/// The energy that the computer's processors use, whichever programs run on them, by the counters
/// of Linux's powercap (RAPL of Intel and AMD).
class EnergyMeter {
 public:
  explicit EnergyMeter(const std::filesystem::path& powercap = "/sys/class/powercap");

  /// Joules since construction. Empty where a counter cannot be read: in most virtual machines
  /// there is none, elsewhere only root reads it. To be called every few minutes, before counters
  /// wrap twice.
  [[nodiscard]] std::optional<double> joules();

 private:
  struct Package {
    std::filesystem::path counter;
    double range_uj;  ///< where it wraps
    double last_uj;
  };

  std::vector<Package> packages_;
  double joules_ = 0;
};

}  // namespace pillarfield
