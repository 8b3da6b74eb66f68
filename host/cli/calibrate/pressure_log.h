#pragma once

#include <string>
#include <vector>

namespace pillarfield::cli {

/// A log of the pressure: a text file of lines "time_s,pressure_kpa" with rising times, linear in
/// between. A first line without numbers is a heading.
class PressureLog {
 public:
  /// Throws Error if the file cannot be read or a line is not two numbers.
  explicit PressureLog(const std::string& file);

  /// Pressure at a time, kPa; that of the first or last line outside of the log.
  [[nodiscard]] double at(double time_s) const;

 private:
  struct Line {
    double time_s;
    double pressure_kpa;
  };
  std::vector<Line> lines_;
};

}  // namespace pillarfield::cli
