#include "viewer/source/selection.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kBlock = 8;  ///< pillars whose statuses are compared at once
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

bool is_finite(const ForceFieldView& forces, std::size_t at) {
  const bool finite = std::isfinite(forces.normal[at]);
  if (!has_pillars(forces)) return finite;
  return finite && std::isfinite(forces.shear_x[at]) && std::isfinite(forces.shear_y[at]);
}

/// Accumulates SelectionSums; moments are about the middle of the skin until finish().
class SumBuilder {
 public:
  SumBuilder(const ForceFieldView& forces, const Pitch& pitch_mm)
      : forces_(forces), pitch_mm_(pitch_mm) {}

  void add(PillarIndex pillar) {
    const std::size_t at = std::size_t{pillar.row} * forces_.cols + pillar.col;
    const std::uint8_t state = forces_.status[at];
    ++sums_.pillars;
    ++sums_.by_region.at(static_cast<std::size_t>(region_of(state)));
    sums_.ambiguous += (state & status::kAmbiguous) != 0 ? 1 : 0;
    sums_.saturated += (state & status::kSaturated) != 0 ? 1 : 0;
    sums_.inconsistent += (state & status::kInconsistent) != 0 ? 1 : 0;
    if ((state & status::kLoaded) != 0 && is_finite(forces_, at)) add_force(pillar, at);
  }

  [[nodiscard]] bool is_idle_block(PillarIndex first) const {
    std::uint64_t block = 0;
    static_assert(sizeof block == kBlock);
    std::memcpy(&block, &forces_.status[std::size_t{first.row} * forces_.cols + first.col], kBlock);
    return block == 0;
  }
  void add_idle(std::uint32_t pillars) {
    sums_.pillars += pillars;
    sums_.by_region[static_cast<std::size_t>(Region::none)] += pillars;
  }

  [[nodiscard]] SelectionSums finish() {
    const auto touched = static_cast<double>(sums_.in_contact);
    sums_.area_mm2 = touched * pitch_mm_.area_mm2();
    sums_.mean_normal = sums_.in_contact == 0 ? 0 : sums_.normal / touched;
    const bool loaded = sums_.normal > 0;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    sums_.centre_x_mm = loaded ? first_x_ / sums_.normal : unknown;
    sums_.centre_y_mm = loaded ? first_y_ / sums_.normal : unknown;
    sums_.moment_z =
        turn_ - (sums_.centre_x_mm * sums_.shear_y - sums_.centre_y_mm * sums_.shear_x);
    return sums_;
  }

 private:
  void add_force(PillarIndex pillar, std::size_t at) {
    const double x = (pillar.col + 0.5 - 0.5 * forces_.cols) * pitch_mm_.col_mm;
    const double y = (0.5 * forces_.rows - pillar.row - 0.5) * pitch_mm_.row_mm;
    const double normal = forces_.normal[at];
    if (sums_.in_contact == 0 || normal > sums_.peak_normal) {
      sums_.peak_normal = normal;
      sums_.peak = pillar;
    }
    ++sums_.in_contact;
    sums_.normal += normal;
    first_x_ += normal * x;
    first_y_ += normal * y;
    if (!has_pillars(forces_)) return;
    sums_.shear_x += forces_.shear_x[at];
    sums_.shear_y += forces_.shear_y[at];
    turn_ += x * forces_.shear_y[at] - y * forces_.shear_x[at];
  }

  const ForceFieldView& forces_;
  Pitch pitch_mm_;
  SelectionSums sums_;
  double first_x_ = 0;  ///< first moments of the normal force, N mm
  double first_y_ = 0;
  double turn_ = 0;  ///< moment of the shear, N mm
};

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

SelectionSums sums_over(const ShownField& field, const PillarRect& rect,
                        const Pitch& element_pitch_mm) {
  SumBuilder adding(field.forces, element_pitch_mm);
  const std::uint32_t row_end = std::min(rect.row_end, field.forces.rows);
  const std::uint32_t col_end = std::min(rect.col_end, field.forces.cols);
  for (std::uint32_t row = rect.row_begin; row < row_end; ++row) {
    for (std::uint32_t col = rect.col_begin; col < col_end;) {
      if (col + kBlock <= col_end && adding.is_idle_block({row, col})) {
        adding.add_idle(kBlock);
        col += kBlock;
      } else {
        adding.add({row, col++});
      }
    }
  }
  return adding.finish();
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
