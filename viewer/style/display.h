#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "pillarfield/pressure_unit.h"

namespace pillarfield::viewer {

// Values become texts here alone: numbers, axes, legends, heads and readouts ask Units.

/// Dimensions of values, which are computed in N, kPa, N mm, mm, mm², rad and s.
enum class Dimension : std::uint8_t {
  none,  ///< a class, or a plain number
  counts,
  force,
  pressure,
  torque,
  length,
  area,
  angle,
  time
};

/// A unit of display.
struct Unit {
  std::string_view name;  ///< "N", "°"; empty for none
  double factor = 1;      ///< displayed number over value
};

/// Texts of a value.
struct ShownValue {
  std::string label;
  std::string value;
  std::string range;  ///< deviation or interval, if known
  std::string unit;
};

/// The units in which values are shown.
struct Units {
  PressureUnit pressure = kPressureUnits.front();
  friend bool operator==(const Units&, const Units&) = default;

  [[nodiscard]] Unit of(Dimension dimension) const;
  [[nodiscard]] double shown(Dimension dimension, double value) const {
    return value * of(dimension).factor;
  }

  /// "Normal force, N"; the words alone without a unit.
  [[nodiscard]] std::string title(std::string_view words, Dimension dimension) const;
  /// A number as three_digits() has it: "12.3".
  [[nodiscard]] std::string number(Dimension dimension, double value) const;
  /// number() with its unit: "12.3 N", "45.0°".
  [[nodiscard]] std::string text(Dimension dimension, double value) const;
  /// With the fewest digits: "20 mm".
  [[nodiscard]] std::string plain(Dimension dimension, double value) const;
  /// With `decimals`: "0.300 s".
  [[nodiscard]] std::string fixed(Dimension dimension, double value, int decimals) const;

  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  /// A value with its deviation, whose two digits set the decimals of both; three_digits() where
  /// the deviation is NaN or 0.
  [[nodiscard]] ShownValue readout(std::string label, Dimension dimension, double value,
                                   double deviation = kUnknown) const;
  /// A value known only as an interval, whose width sets the decimals.
  [[nodiscard]] ShownValue readout_between(std::string label, Dimension dimension, double value,
                                           double low, double high) const;
};

/// `number` after its unit's manner: "12.3 N", "45°"; without one the number alone.
[[nodiscard]] std::string with_unit(const std::string& number, std::string_view unit);

}  // namespace pillarfield::viewer
