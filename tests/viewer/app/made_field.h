#pragma once

#include "viewer/app/app_state.h"

namespace pillarfield::viewer {

/// Readings of the model under a ball that presses and shears 32 x 40 pillars, with the solver's
/// forces and uncertainty.
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
  /// Stores whole counts in the frame; returns them in newtons.
  std::array<double, 4> read(PillarIndex pillar, const std::array<double, 4>& model);
};

}  // namespace pillarfield::viewer
