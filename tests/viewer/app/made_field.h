#pragma once

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Forces, readings and uncertainty that the model gives for a ball that presses and shears a skin
/// of 32 x 40 pillars, as a solver would find them.
struct MadeField {
  MadeField();

  [[nodiscard]] ShownField shown() const;
  [[nodiscard]] SourceInfo source() const;

  Skin skin;
  ForceField forces;
  std::vector<float> magnitude, theta, phi;
  std::vector<std::uint16_t> readings;

 private:
  void set_pillar(PillarIndex pillar);
  /// Whole counts go into the frame; returned in newtons, as the solver has them.
  std::array<double, 4> read(PillarIndex pillar, const std::array<double, 4>& model);
};

/// A history of `points` frames, 100 a second, that ends in a force.
[[nodiscard]] History made_history(const PillarValues& last, std::size_t points);

}  // namespace pillarfield::viewer
