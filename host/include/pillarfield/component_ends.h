#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "pillarfield/force_field.h"

namespace pillarfield {

/// The ends of what a component of a force may be, N: the 95 % interval that files and displays
/// give beside the standard deviations of Uncertainty.
enum class ComponentEnd : std::uint8_t {
  shear_x_low,
  shear_x_high,
  shear_y_low,
  shear_y_high,
  normal_low,
  normal_high,
};
inline constexpr std::size_t kComponentEnds = 6;

/// "shear_x_low", ...: as in files.
[[nodiscard]] const char* name_of(ComponentEnd end);

/// The six ends of one pillar, in the order of ComponentEnd: the estimate and 1.96 standard
/// deviations either way, a normal force not below zero (docs/derivations/uncertainty.md, section
/// 3).
///
/// Of forces that the direct solve left at `direct_point` of their segments (SolverPlan::
/// segment_point) they are the ends of the segment instead, and 1.96 deviations of the noise beyond
/// them; unset: the forces are another estimator's. The field must have its uncertainty.
[[nodiscard]] std::array<float, kComponentEnds> component_ends(
    const ForceFieldView& forces, std::size_t pillar, const std::optional<double>& direct_point);

}  // namespace pillarfield
