#pragma once

namespace pillarfield::viewer {

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
