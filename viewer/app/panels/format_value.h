#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "pillarfield/contact_quantities.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// Standard deviations of magnitude (N), theta and phi (rad), to first order, from those of the
/// components, assumed independent; NaN without a direction (no force, or for phi no shear).
struct DirectionDeviation {
  double magnitude, theta, phi;
};
[[nodiscard]] DirectionDeviation direction_deviation(const PillarValues& values);

/// "row 12, column 34".
[[nodiscard]] std::string format_pillar(PillarIndex pillar);

/// "x 12.65, y −3.79 mm": the centre of a pillar from the middle of the skin.
[[nodiscard]] std::string format_place(const ForceFieldView& forces, PillarIndex pillar,
                                       double pillar_pitch_mm);

/// "12", or "12.3" for a number that is not whole.
[[nodiscard]] std::string format_count(double counts);

/// "12  34  0  7  counts", in the order of the sensels.
[[nodiscard]] std::string format_readings(const std::array<float, 4>& readings);

/// "region 3, ambiguous", "no contact", "region 1, saturated".
[[nodiscard]] std::string format_status(std::uint8_t status);

/// The value with the decimals of two digits of its deviation ("0.1234" for 0.0056); three_digits()
/// where the deviation is NaN or 0.
[[nodiscard]] std::string format_value(double value, double deviation);

/// "± 0.0056", with two digits; empty for NaN.
[[nodiscard]] std::string format_deviation(double deviation);

/// "0.12 … 0.34", with the decimals of two digits of its width.
[[nodiscard]] std::string format_interval(double low, double high);

/// Displayed texts of a quantity.
struct ShownValue {
  std::string label;
  std::string value;
  std::string range;  ///< deviation or interval, if known
  std::string unit;
};

/// Magnitude, theta and phi, with intervals for an ambiguous pillar, else deviations.
[[nodiscard]] std::array<ShownValue, 3> shown_direction(const PillarValues& values);

/// Normal, shear x and shear y, with deviations.
[[nodiscard]] std::array<ShownValue, 3> shown_components(const PillarValues& values);

inline constexpr std::size_t kContactColumns = 9;

/// A column of the table of contacts.
struct ContactColumn {
  const char* head;    ///< "normal"
  const char* help;    ///< "normal force, N"
  const char* widest;  ///< sample text that sets the width
};
[[nodiscard]] const std::array<ContactColumn, kContactColumns>& contact_columns();

/// A row of the table: `name`, then contact_columns(), numbers with three digits; "–" for missing
/// values.
[[nodiscard]] std::array<std::string, kContactColumns> format_contact(
    const std::string& name, const ContactQuantities& contact);

}  // namespace pillarfield::viewer
