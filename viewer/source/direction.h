#pragma once

namespace pillarfield::viewer {

/// Magnitude and direction of a force; (theta, phi) is where it comes from
/// (docs/derivations/pillar_model.md, equation M2).
struct Direction {
  float magnitude = 0;  ///< N
  float theta = 0;      ///< rad from the outward normal, [0, pi]; 0 without force
  float phi = 0;        ///< rad in the plane of the skin, (-pi, pi]; 0 without shear
};

/// Of a force in newtons, in single precision as a solver with angles gives it: within 3 ULP of the
/// exact values, as its are.
[[nodiscard]] Direction direction_of(float shear_x, float shear_y, float normal);

}  // namespace pillarfield::viewer
