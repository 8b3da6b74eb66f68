#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "viewer/source/field_producer.h"
#include "viewer/style/display.h"

namespace pillarfield::viewer {

/// Quantities of the heat map, in the order of shaders/shared.h.
enum class Quantity : std::uint8_t {
  normal,       ///< N
  shear,        ///< |shear|, N
  shear_x,      ///< N
  shear_y,      ///< N
  magnitude,    ///< |force|, N
  theta,        ///< angle from the outward normal, rad
  phi,          ///< direction in the plane from which the force comes, rad
  region,       ///< region of the paper's Figure 3
  status,       ///< StatusClass
  uncertainty,  ///< root of the summed variances of the components, N; for ambiguous pillars at
                ///< least half the interval of the magnitude
  parity,       ///< V1 + V3 - V2 - V4 of the readings, counts
  pressure,     ///< normal force over the area of a pillar or sensel, kPa
};
inline constexpr int kQuantities = 12;

enum class Scale : std::uint8_t { sequential, diverging, cyclic, classes };

struct QuantityInfo {
  const char* name;   ///< on the command line: "shear_x"
  const char* title;  ///< in the picture: "Shear x"
  Dimension dimension;
  Scale scale;
  bool (*is_in)(const SourceInfo& source);  ///< see is_available()
};
[[nodiscard]] const QuantityInfo& info_of(Quantity quantity);

/// Values of `status`; the worst applies.
enum class StatusClass : std::uint8_t {
  determined,
  ambiguous,
  from_contact,
  saturated,
  inconsistent
};
inline constexpr int kStatusClasses = 5;
[[nodiscard]] StatusClass status_class(std::uint8_t status);

/// True if a sensel is usable or saturated.
[[nodiscard]] bool is_pressed(std::uint8_t status);

/// True if the source has the data of the quantity; sensels without pillars have only normal force.
[[nodiscard]] bool is_available(Quantity quantity, const SourceInfo& source);

/// Ends of the colour bar in the unit of the value. Default: low = 0 for sequential quantities,
/// low = -high for diverging ones.
struct Range {
  float low = 0;
  float high = 1;
  friend bool operator==(const Range&, const Range&) = default;
};

/// Pressure of a newton on a pillar or sensel, kPa.
[[nodiscard]] float kpa_per_newton(const Skin& skin);

/// Largest finite |value| over pillars that are neither idle, saturated nor inconsistent; 0 for
/// none.
[[nodiscard]] float largest(Quantity quantity, const ShownField& field, const Skin& skin);

/// 0 for a shear that is rounding beside the normal force, so that no range is fitted to it.
[[nodiscard]] float without_rounding(Quantity quantity, float value, float normal_n);

/// Range for a largest value: its round_ceiling(), 1 for a value of 0; always [0, pi/2] for theta,
/// [-pi, pi] for phi and [0, number of classes] for classes.
[[nodiscard]] Range fitting_range(Quantity quantity, float largest_value);

/// The value of one pillar or sensel by the operations of shaders/value.glsl, in single precision
/// without contraction. In the uncertainty of sensels the deviations of the shear are zero. NaN
/// where the source lacks the data or the pillar is idle: not is_pressed(); for region no usable
/// sensel; for status not pressed and no fault.
[[nodiscard]] float value_of(Quantity quantity, const ShownField& field, const Skin& skin,
                             std::uint32_t row, std::uint32_t col);

}  // namespace pillarfield::viewer
