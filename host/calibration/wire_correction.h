#pragma once

#include <optional>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/sensor_effects.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Frames without the crosstalk of wires, float32: what a step sees whose calibration has wires.
class WireCorrection {
 public:
  /// Frames of this skin and type; they stay as they are without `wires`.
  WireCorrection(const Skin& skin, SenselType type, const std::optional<WireCrosstalk>& wires);

  /// The skin of the corrected frames: its full scale is above all corrected readings.
  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] SenselType type() const { return corrected_ ? SenselType::f32 : plan_.sensel_type; }

  /// Corrects a frame; the result is valid until the next call. A sensel at full scale stays at
  /// full scale, and is NaN where the readout is saturated.
  [[nodiscard]] FrameView operator()(const FrameView& raw);

 private:
  SolverPlan plan_;
  Skin skin_;
  std::optional<FrameBuffer> corrected_;
};

}  // namespace pillarfield
