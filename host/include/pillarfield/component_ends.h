#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "pillarfield/force_field.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// The ends of the 95 % intervals of a force's components, N.
enum class ComponentEnd : std::uint8_t {
  shear_x_low,
  shear_x_high,
  shear_y_low,
  shear_y_high,
  normal_low,
  normal_high,
};
inline constexpr std::size_t kComponentEnds = 6;

/// "shear_x_low", ..., as in files.
[[nodiscard]] const char* name_of(ComponentEnd end);

/// The 95 % intervals of one pillar, in the order of ComponentEnd: the estimate ± 1.96 standard
/// deviations, a normal force clamped at zero (docs/derivations/uncertainty.md, section 3). A
/// component that saturated sensels leave open has ends beyond ± kOpenN.
///
/// For ambiguous pillars of Estimator::direct pass its SolverPlan::segment_point as `direct_point`:
/// their intervals then span the segment, widened by 1.96 standard deviations of the noise. Leave
/// it unset for other estimators. `coefficient` is that of the skin. `forces` must have the planes
/// of Uncertainty. Without pillars the ends of shear are zero.
[[nodiscard]] std::array<float, kComponentEnds> component_ends(
    const ForceFieldView& forces, std::size_t pillar, const std::optional<double>& direct_point,
    const ShearCoefficient& coefficient = {});

}  // namespace pillarfield
