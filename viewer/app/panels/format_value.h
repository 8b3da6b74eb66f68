#pragma once

#include <array>
#include <string>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Standard deviations of a force's magnitude (N), theta and phi (rad) from those of its
/// components, to first order and as if those were independent; NaN where the direction is not
/// determined (no force, or for phi no shear).
struct DirectionDeviation {
  double magnitude, theta, phi;
};
[[nodiscard]] DirectionDeviation direction_deviation(const PillarValues& values);

/// "row 12, column 34".
[[nodiscard]] std::string format_pillar(PillarIndex pillar);

/// "x 12.65, y −3.79 mm": the middle of a pillar, from that of the skin.
[[nodiscard]] std::string format_place(const ForceFieldView& forces, PillarIndex pillar,
                                       double pillar_pitch_mm);

/// "12", and "12.3" of what is no whole number.
[[nodiscard]] std::string format_count(double counts);

/// "12  34  0  7  counts": the four readings in the order of the sensels.
[[nodiscard]] std::string format_readings(const std::array<float, 4>& readings);

/// "region 3, ambiguous", "no contact", "region 1, saturated": what a status byte says.
[[nodiscard]] std::string format_status(std::uint8_t status);

/// A number with as many decimals as two digits of its deviation have ("0.1234" of 0.0056), with
/// three_digits() where that is no number or zero.
[[nodiscard]] std::string format_value(double value, double deviation);

/// "± 0.0056": two digits. Empty where it is no number.
[[nodiscard]] std::string format_deviation(double deviation);

/// "0.12 … 0.34": ends with as many decimals as two digits of what is between them have.
[[nodiscard]] std::string format_interval(double low, double high);

/// A quantity of a pillar as it is displayed.
struct ShownValue {
  std::string label;
  std::string value;
  std::string range;  ///< deviation or interval, where known
  std::string unit;
};

/// Magnitude, theta and phi: with intervals where the pillar is ambiguous, deviations elsewhere.
[[nodiscard]] std::array<ShownValue, 3> shown_direction(const PillarValues& values);

/// Normal, shear x and shear y, with deviations.
[[nodiscard]] std::array<ShownValue, 3> shown_components(const PillarValues& values);

}  // namespace pillarfield::viewer
