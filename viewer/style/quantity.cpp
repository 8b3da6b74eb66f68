#include "viewer/style/quantity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "pillarfield/status.h"
#include "viewer/source/selection.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr auto kHalfTurn = std::numbers::pi_v<float>;

bool any(const SourceInfo& /*source*/) { return true; }
bool pillars(const SourceInfo& source) { return source.skin.has_pillars(); }
bool angles(const SourceInfo& source) { return source.has_angles; }
bool uncertain(const SourceInfo& source) { return source.has_uncertainty; }
bool readings(const SourceInfo& source) { return source.has_readings && pillars(source); }

constexpr std::array<QuantityInfo, kQuantities> kInfos = {{
    {"normal", "Normal force", Dimension::force, Scale::sequential, any},
    {"shear", "Shear", Dimension::force, Scale::sequential, pillars},
    {"shear_x", "Shear x", Dimension::force, Scale::diverging, pillars},
    {"shear_y", "Shear y", Dimension::force, Scale::diverging, pillars},
    {"magnitude", "Magnitude", Dimension::force, Scale::sequential, angles},
    {"theta", "Inclination θ", Dimension::angle, Scale::sequential, angles},
    {"phi", "Direction φ", Dimension::angle, Scale::cyclic, angles},
    {"region", "Region", Dimension::none, Scale::classes, pillars},
    {"status", "Status", Dimension::none, Scale::classes, any},
    {"uncertainty", "Uncertainty", Dimension::force, Scale::sequential, uncertain},
    {"parity", "Parity residual", Dimension::counts, Scale::diverging, readings},
    {"pressure", "Pressure", Dimension::pressure, Scale::sequential, any},
}};

float root_of_squares(float x, float y) { return std::sqrt(x * x + y * y); }

float value_in(std::span<const float> plane, std::size_t pillar) {
  return plane.empty() ? kNothing : plane[pillar];
}

float uncertainty_of(const ForceFieldView& forces, std::size_t pillar) {
  const auto at = [&](Uncertainty plane) { return value_in(forces.uncertainty[plane], pillar); };
  const float x = has_pillars(forces) ? at(Uncertainty::shear_x) : 0;
  const float y = has_pillars(forces) ? at(Uncertainty::shear_y) : 0;
  const float n = at(Uncertainty::normal);
  const float deviation = std::sqrt((x * x + y * y) + n * n);
  if ((forces.status[pillar] & status::kAmbiguous) == 0) return deviation;
  const float half = 0.5F * (at(Uncertainty::magnitude_high) - at(Uncertainty::magnitude_low));
  return half > deviation ? half : deviation;
}

template <class Reading>
float parity_of_readings(const FrameView& raw, std::uint32_t row, std::uint32_t col) {
  const auto* upper =
      static_cast<const Reading*>(raw.data) + 2 * (row * raw.row_stride + std::size_t{col});
  const auto* lower = upper + raw.row_stride;
  const auto v2 = static_cast<float>(upper[0]);
  const auto v1 = static_cast<float>(upper[1]);
  const auto v3 = static_cast<float>(lower[0]);
  const auto v4 = static_cast<float>(lower[1]);
  return (v1 + v3) - (v2 + v4);
}

float parity_of(const FrameView& raw, std::uint32_t row, std::uint32_t col) {
  if (raw.data == nullptr) return kNothing;
  switch (raw.type) {
    case SenselType::u8:
      return parity_of_readings<std::uint8_t>(raw, row, col);
    case SenselType::u16:
      return parity_of_readings<std::uint16_t>(raw, row, col);
    case SenselType::f32:
      break;
  }
  return parity_of_readings<float>(raw, row, col);
}

bool is_faulty(std::uint8_t status) {
  return (status & (status::kSaturated | status::kInconsistent)) != 0;
}

float region_value(std::uint8_t status) {
  const Region region = region_of(status);
  return region == Region::none ? kNothing : static_cast<float>(region);
}

float status_value(std::uint8_t status) {
  const bool idle = !is_pressed(status) && !is_faulty(status);
  return idle ? kNothing : static_cast<float>(status_class(status));
}

/// The value of a pressed pillar; region and status apply to any pillar.
float pressed_value(Quantity quantity, const ShownField& field, const Skin& skin, std::uint32_t row,
                    std::uint32_t col) {
  const ForceFieldView& forces = field.forces;
  const std::size_t pillar = std::size_t{row} * forces.cols + col;
  switch (quantity) {
    case Quantity::normal:
      return forces.normal[pillar];
    case Quantity::pressure:
      return forces.normal[pillar] * kpa_per_newton(skin);
    case Quantity::shear:
      return root_of_squares(forces.shear_x[pillar], forces.shear_y[pillar]);
    case Quantity::shear_x:
      return forces.shear_x[pillar];
    case Quantity::shear_y:
      return forces.shear_y[pillar];
    case Quantity::magnitude:
      return value_in(forces.magnitude, pillar);
    case Quantity::theta:
      return value_in(forces.theta, pillar);
    case Quantity::phi:
      return value_in(forces.phi, pillar);
    case Quantity::region:
      return region_value(forces.status[pillar]);
    case Quantity::status:
      return status_value(forces.status[pillar]);
    case Quantity::uncertainty:
      return uncertainty_of(forces, pillar);
    case Quantity::parity:
      break;
  }
  return parity_of(field.raw, row, col);
}

/// round_ceiling() in single precision.
float nice_float(float value) {
  constexpr double kMost = 1e38;
  // 0.1 in single precision slightly exceeds 0.1 and must still round to 0.1.
  const double exact = std::clamp(double{value}, 1e-37, kMost);
  const auto nice = static_cast<float>(round_ceiling(exact * (1 - 0x1p-23)));
  return nice >= value ? nice : static_cast<float>(std::min(round_ceiling(exact), kMost));
}

}  // namespace

const QuantityInfo& info_of(Quantity quantity) {
  return kInfos.at(static_cast<std::size_t>(quantity));
}

StatusClass status_class(std::uint8_t status) {
  if ((status & status::kInconsistent) != 0) return StatusClass::inconsistent;
  if ((status & status::kSaturated) != 0) return StatusClass::saturated;
  if ((status & status::kFromNeighbours) != 0) return StatusClass::from_contact;
  return (status & status::kAmbiguous) != 0 ? StatusClass::ambiguous : StatusClass::determined;
}

bool is_pressed(std::uint8_t status) { return (status & status::kLoaded) != 0; }

bool is_available(Quantity quantity, const SourceInfo& source) {
  return info_of(quantity).is_in(source);
}

float kpa_per_newton(const Skin& skin) {
  return pillarfield::kpa_per_newton(skin.element_pitch_mm());
}

float largest(Quantity quantity, const ShownField& field, const Skin& skin) {
  float largest = 0;
  float normal = 0;
  for (std::uint32_t row = 0; row < field.forces.rows; ++row) {
    const std::size_t first = std::size_t{row} * field.forces.cols;
    for (std::uint32_t col = 0; col < field.forces.cols; ++col) {
      const std::uint8_t status = field.forces.status[first + col];
      if (!is_pressed(status) || is_faulty(status)) continue;
      const float size = std::abs(pressed_value(quantity, field, skin, row, col));
      if (size < 0.1F * kOpenN && size > largest) largest = size;
      normal = std::max(normal, field.forces.normal[first + col]);
    }
  }
  return without_rounding(quantity, largest, normal);
}

float without_rounding(Quantity quantity, float value, float normal_n) {
  constexpr float kRounding = 1e-6f;
  const bool shear =
      quantity == Quantity::shear || quantity == Quantity::shear_x || quantity == Quantity::shear_y;
  return shear && value < kRounding * normal_n ? 0 : value;
}

Range fitting_range(Quantity quantity, float largest_value) {
  if (quantity == Quantity::theta) return {0, kHalfTurn / 2};
  if (quantity == Quantity::phi) return {-kHalfTurn, kHalfTurn};
  if (quantity == Quantity::region) return {0, kRegions};
  if (quantity == Quantity::status) return {0, kStatusClasses};
  const bool fits = std::isfinite(largest_value) && largest_value > 0;
  const float high = fits ? nice_float(largest_value) : 1;
  return {info_of(quantity).scale == Scale::diverging ? -high : 0, high};
}

float value_of(Quantity quantity, const ShownField& field, const Skin& skin, std::uint32_t row,
               std::uint32_t col) {
  const std::uint8_t status = field.forces.status[std::size_t{row} * field.forces.cols + col];
  const bool of_any = quantity == Quantity::region || quantity == Quantity::status;
  if (!of_any && !is_pressed(status)) return kNothing;
  return pressed_value(quantity, field, skin, row, col);
}

}  // namespace pillarfield::viewer
