#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "pillarfield/component_ends.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// True if the elements of a field are pillars; sensels have no shear.
[[nodiscard]] inline bool has_pillars(const ForceFieldView& forces) {
  return !forces.shear_x.empty();
}

/// A pillar, or a sensel of a field without pillars; likewise below.
struct PillarIndex {
  std::uint32_t row = 0;
  std::uint32_t col = 0;
  friend bool operator==(const PillarIndex&, const PillarIndex&) = default;
};

/// Pillars [row_begin, row_end) x [col_begin, col_end).
struct PillarRect {
  std::uint32_t row_begin = 0, row_end = 0, col_begin = 0, col_end = 0;
  friend bool operator==(const PillarRect&, const PillarRect&) = default;
};

/// Readings and results of one pillar in one frame. A sensel has a single reading, normal force and
/// its deviation; the others are zero, and the uncertainty that it lacks is NaN.
struct PillarValues {
  bool has_pillars = true;
  std::array<float, 4> readings{};             ///< raw counts, sensels 1..4; NaN without readings
  float shear_x = 0, shear_y = 0, normal = 0;  ///< N
  float magnitude = 0, theta = 0, phi = 0;     ///< N, rad, rad; computed for a field without planes
  std::optional<std::array<float, kUncertaintyPlanes>> uncertainty;
  std::array<float, kComponentEnds> component_ends{};  ///< with `uncertainty` only
  std::uint8_t status = 0;
};

/// Throws Error for a pillar outside the field.
[[nodiscard]] PillarValues values_at(const ShownField& field, PillarIndex pillar);

/// Magnitude of a force and the direction (theta, phi) from which it comes
/// (docs/derivations/pillar_model.md, equation M2).
struct Direction {
  float magnitude = 0;  ///< N
  float theta = 0;      ///< rad from the outward normal, [0, pi]; 0 without force
  float phi = 0;        ///< rad in the plane of the skin, (-pi, pi]; 0 without shear
};

/// Computes the direction of a force in newtons, within 3 ULP of the exact values, the bound of a
/// solver with angles.
[[nodiscard]] Direction direction_of(float shear_x, float shear_y, float normal);

}  // namespace pillarfield::viewer
