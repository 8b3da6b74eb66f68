#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

/// What the heat map shows of each pillar. The order is that of shaders/shared.h.
enum class Quantity : std::uint8_t {
  normal,       ///< N
  shear,        ///< |shear|, N
  shear_x,      ///< N
  shear_y,      ///< N
  magnitude,    ///< |force|, N
  theta,        ///< angle from the outward normal, rad
  phi,          ///< direction in the plane from which the force comes, rad
  region,       ///< of the paper's Figure 3
  status,       ///< what is wrong with the pillar
  uncertainty,  ///< root of the summed variances of the three components, N; of ambiguous pillars
                ///< half of what the magnitude may span where that is more
  parity,       ///< V1 + V3 - V2 - V4 of the readings, counts
};
inline constexpr int kQuantities = 11;

enum class Scale : std::uint8_t { sequential, diverging, cyclic, classes };

struct QuantityInfo {
  const char* name;   ///< for the command line: "shear_x"
  const char* title;  ///< for the picture: "Shear x"
  const char* unit;   ///< of what is displayed: "N", "°", "counts", ""
  double factor;      ///< from the value to what is displayed: 180/pi for angles, else 1
  Scale scale;
};
[[nodiscard]] const QuantityInfo& info_of(Quantity quantity);
[[nodiscard]] std::optional<Quantity> quantity_named(std::string_view name);

/// Values of `status`, by what is worst.
enum class StatusClass : std::uint8_t { sound, ambiguous, from_contact, saturated, inconsistent };
inline constexpr int kStatusClasses = 5;
[[nodiscard]] StatusClass status_class(std::uint8_t status);

/// Whether a sensel is usable or saturated: something presses.
[[nodiscard]] bool is_pressed(std::uint8_t status);

/// Whether a source has what it takes.
[[nodiscard]] bool is_available(Quantity quantity, const SourceInfo& source);

/// Ends of the colour bar, in the value's own unit. Of sequential quantities low is 0 unless chosen
/// otherwise, of diverging ones low = -high.
struct Range {
  float low = 0;
  float high = 1;
  friend bool operator==(const Range&, const Range&) = default;
};

/// The largest finite |value| of a quantity in a field, over pillars that are neither idle, nor
/// saturated, nor inconsistent; zero where there is none.
[[nodiscard]] float largest(Quantity quantity, const ShownField& field);

/// The range that fits largest values seen: up to their round_ceiling(), and 1 where there is
/// nothing to fit; theta [0, pi/2], phi [-pi, pi], and of classes [0, how many] always.
[[nodiscard]] Range fitting_range(Quantity quantity, float largest_value);

/// The value of one pillar, as the heat map's shader computes it: in single precision, without
/// contraction, by these operations, `x`, `y`, `n` being the planes shear_x, shear_y and normal.
///
///     normal, shear_x, shear_y     n, x, y
///     shear                        sqrt(x*x + y*y)
///     magnitude, theta, phi        as in their planes
///     region                       float(region_of(status)): 1 to 5
///     status                       float(status_class(status)): 0 to 4
///     uncertainty                  s = sqrt((sx*sx + sy*sy) + sn*sn) of the deviations; where the
///                                  status is ambiguous h = 0.5*(magnitude_high - magnitude_low),
///                                  and h > s ? h : s
///     parity                       (V1 + V3) - (V2 + V4) of the readings as floats
///
/// NaN where the source lacks what it takes, and where the pillar is idle: not is_pressed(); for
/// region nothing usable, for status nothing pressed and no fault.
[[nodiscard]] float value_of(Quantity quantity, const ShownField& field, std::uint32_t row,
                             std::uint32_t col);

}  // namespace pillarfield::viewer
