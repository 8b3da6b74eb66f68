#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/sensor_effects.h"
#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// Frames without the crosstalk of wires, tare included, float32: what a step sees whose
/// calibration has wires.
class WireCorrection {
 public:
  /// Frames `name` of this skin and type. They stay as they are without `wires`, and where tares
  /// are an offset behind them that is not known yet.
  WireCorrection(std::string name, const Skin& skin, SenselType type,
                 const std::optional<WireCrosstalk>& wires, std::vector<float> tare);

  /// The skin of the corrected frames: its full scale is above all corrected readings.
  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] SenselType type() const { return corrected_ ? SenselType::f32 : plan_.sensel_type; }

  /// Corrects a frame; the result is valid until the next call. A sensel at full scale stays at
  /// full scale. Throws Error where a row loses more of its voltage than a calibration bears.
  [[nodiscard]] FrameView operator()(const FrameView& raw);

  /// The same whatever a row loses; NaN where the readout is saturated.
  [[nodiscard]] FrameView unlimited(const FrameView& raw);

 private:
  /// A reading behind wires without their crosstalk.
  [[nodiscard]] float corrected(float reading, std::size_t sensel,
                                const single_precision::Wires& at) const;

  std::string name_;
  SolverPlan plan_;
  Skin skin_;
  std::optional<FrameBuffer> corrected_;  ///< unset: frames stay
  float largest_gain_ = 1;                ///< of a row in the last frame
};

}  // namespace pillarfield
