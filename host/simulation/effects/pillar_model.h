#pragma once

#include <cstdint>

#include "pillarfield/force_field.h"
#include "pillarfield/scene.h"
#include "simulation/pressure_moments.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// The pillars of a scene: from the forces on them to the force that each passes to its sensels.
///
///     f  = force + edge · Σ force of the 4 nearest + corner · Σ force of the 4 diagonal pillars
///     s  = (c_x (f_x + moment_x/arm), c_y (f_y + moment_y/arm), f_normal)
///
/// V of the four sensels is that of an ideal pillar under s: V = k (normal ± s_x/√2 ± s_y/√2).
class PillarModel {
 public:
  explicit PillarModel(const SensorEffects& effects);

  /// True if each pillar passes on the force on it.
  [[nodiscard]] bool is_ideal() const { return is_ideal_; }
  [[nodiscard]] bool needs_moments() const { return per_arm_ != 0; }

  /// s of one pillar. `moments` may be empty unless needs_moments().
  [[nodiscard]] double_precision::Force force_on_sensels(const ForceField& forces,
                                                         const PressureMoments& moments,
                                                         std::uint32_t row,
                                                         std::uint32_t col) const;

 private:
  bool is_ideal_;
  PillarLeak leak_;
  double per_arm_;  ///< 1/mm; 0 without the effect
  ShearCoefficient coefficient_;
};

}  // namespace pillarfield
