#pragma once

#include <string>
#include <vector>

namespace pillarfield {

/// A log of the pressure: a text file of lines "time_s,pressure_kpa" with rising times, linear in
/// between. A first line without numbers is a heading.
class PressureLog {
 public:
  /// Throws Error if the file cannot be read or a line is not two numbers.
  explicit PressureLog(const std::string& file);

  /// The log of frames at these times. Throws Error, naming `where`, unless each has a pressure.
  PressureLog(const std::string& where, const std::vector<double>& times_s,
              const std::vector<double>& pressures_kpa);

  /// Pressure at a time, kPa; that of the first or last line outside of the log.
  [[nodiscard]] double at(double time_s) const;

 private:
  struct Line {
    double time_s;
    double pressure_kpa;
  };
  void add(const Line& line, const std::string& where);

  std::vector<Line> lines_;
};

}  // namespace pillarfield
