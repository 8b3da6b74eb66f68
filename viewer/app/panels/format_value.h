#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "pillarfield/contact_columns.h"
#include "pillarfield/skin.h"
#include "viewer/source/selection.h"
#include "viewer/style/display.h"

namespace pillarfield::viewer {

/// Standard deviations of magnitude (N), theta and phi (rad), to first order, from those of the
/// components, assumed independent; NaN without a direction (no force, or for phi no shear).
struct DirectionDeviation {
  double magnitude, theta, phi;
};
[[nodiscard]] DirectionDeviation direction_deviation(const PillarValues& values);

/// "pillar" or "sensel": what an element of the field is.
[[nodiscard]] const char* element_name(const Skin& skin);

/// "row 12, column 34".
[[nodiscard]] std::string format_pillar(PillarIndex pillar);

/// "x 12.65, y −3.79 mm": the centre of a pillar or sensel from the middle of the skin.
[[nodiscard]] std::string format_place(const ForceFieldView& forces, PillarIndex pillar,
                                       const Pitch& element_pitch_mm, const Units& units);

/// "12", or "12.3" for a number that is not whole.
[[nodiscard]] std::string format_count(double counts);

/// "readings 1–4: 12  34  0  7  counts", in the order of the sensels; "reading: 12  counts" of a
/// sensel without a pillar.
[[nodiscard]] std::string format_readings(const PillarValues& values);

/// "region 3, ambiguous", "no contact", "region 1, saturated".
[[nodiscard]] std::string format_status(std::uint8_t status);

/// State of a sensel without a pillar: "in contact", "no contact", "saturated", "no reading".
[[nodiscard]] std::string format_sensel_status(std::uint8_t status);

/// Magnitude, theta and phi, with intervals for an ambiguous pillar, else deviations.
[[nodiscard]] std::array<ShownValue, 3> shown_direction(const PillarValues& values,
                                                        const Units& units);

/// Normal, shear x and shear y, with deviations.
[[nodiscard]] std::array<ShownValue, 3> shown_components(const PillarValues& values,
                                                         const Units& units);

/// Normal force with its deviation, of a pillar with the other components, of a sensel with the
/// pressure.
[[nodiscard]] std::vector<ShownValue> shown_forces(const PillarValues& values, const Skin& skin,
                                                   const Units& units);

/// Three digits, and at most four decimals: seven characters.
[[nodiscard]] std::string table_number(double value);

/// A quantity of a contact as a table_number(), a pressure in `unit`; "–" for a missing value and
/// for the first word, which claims nothing.
[[nodiscard]] std::string format_quantity(const QuantityColumn& column,
                                          const ContactQuantities& contact,
                                          const PressureUnit& unit);

}  // namespace pillarfield::viewer
