#include "viewer/source/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

float reading_at(const FrameView& raw, std::size_t row, std::size_t col) {
  const std::size_t at = row * raw.row_stride + col;
  switch (raw.type) {
    case SenselType::u8:
      return static_cast<const std::uint8_t*>(raw.data)[at];
    case SenselType::u16:
      return static_cast<const std::uint16_t*>(raw.data)[at];
    case SenselType::f32:
      break;
  }
  return static_cast<const float*>(raw.data)[at];
}

/// Sensels 1 to 4: upper right, upper left, lower left, lower right.
std::array<float, 4> readings_of(const ShownField& field, PillarIndex pillar) {
  const FrameView& raw = field.raw;
  if (raw.data == nullptr) return {kUnknown, kUnknown, kUnknown, kUnknown};
  if (!has_pillars(field.forces)) {
    return {reading_at(raw, pillar.row, pillar.col), kUnknown, kUnknown, kUnknown};
  }
  const std::size_t row = std::size_t{2} * pillar.row;
  const std::size_t col = std::size_t{2} * pillar.col;
  return {reading_at(raw, row, col + 1), reading_at(raw, row, col), reading_at(raw, row + 1, col),
          reading_at(raw, row + 1, col + 1)};
}

void set_direction(PillarValues& values, const ForceFieldView& forces, std::size_t at) {
  Direction direction;
  if (forces.phi.empty()) {
    direction = direction_of(values.shear_x, values.shear_y, values.normal);
  } else {
    direction = {forces.magnitude[at], forces.theta[at], forces.phi[at]};
  }
  values.magnitude = direction.magnitude;
  values.theta = direction.theta;
  values.phi = direction.phi;
}

void set_uncertainty(PillarValues& values, const ShownField& field, std::size_t at) {
  const ForceFieldView& forces = field.forces;
  if (forces.uncertainty[Uncertainty::normal].empty()) return;
  std::ranges::transform(
      forces.uncertainty, values.uncertainty.emplace().begin(),
      [at](std::span<const float> plane) { return plane.empty() ? kUnknown : plane[at]; });
  values.component_ends = component_ends(forces, at, field.direct_point, field.shear_coefficient);
}

}  // namespace

PillarValues values_at(const ShownField& field, PillarIndex pillar) {
  const ForceFieldView& forces = field.forces;
  if (pillar.row >= forces.rows || pillar.col >= forces.cols) {
    throw Error("values_at", fmt::format("there is nothing at ({}, {})", pillar.row, pillar.col),
                fmt::format("the field has {} x {}", forces.rows, forces.cols));
  }
  const std::size_t at = std::size_t{pillar.row} * forces.cols + pillar.col;
  PillarValues values;
  values.has_pillars = has_pillars(forces);
  values.readings = readings_of(field, pillar);
  values.normal = forces.normal[at];
  values.status = forces.status[at];
  if (values.has_pillars) {
    values.shear_x = forces.shear_x[at];
    values.shear_y = forces.shear_y[at];
    set_direction(values, forces, at);
  }
  set_uncertainty(values, field, at);
  return values;
}

Direction direction_of(float shear_x, float shear_y, float normal) {
  // Most pillars carry no force; atan2 of a negative zero would give theta = pi.
  if (shear_x == 0 && shear_y == 0 && normal == 0) return {};
  // In double precision squares of floats neither overflow nor underflow.
  const double x = shear_x;
  const double y = shear_y;
  const double z = normal;
  const double shear_squared = x * x + y * y;
  Direction direction;
  direction.magnitude = static_cast<float>(std::sqrt(shear_squared + z * z));
  direction.theta = std::atan2(static_cast<float>(std::sqrt(shear_squared)), normal);
  // 0 - x maps +0 to +0; -x would give -0 and flip phi across the branch cut.
  direction.phi = std::atan2(0.0F - shear_y, 0.0F - shear_x);
  return direction;
}

}  // namespace pillarfield::viewer
