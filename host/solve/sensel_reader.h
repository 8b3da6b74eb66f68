#pragma once

#include <cstddef>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "solve/pillar_maths.h"
#include "solve/plan_constants.h"

namespace pillarfield {

/// Sensels of a frame after the stages of a plan, in single precision as on the device. Plan and
/// frame must fit each other and outlive the reader.
class SenselReader {
 public:
  SenselReader(const SolverPlan& plan, const FrameView& frame)
      : calibration_(plan.calibration),
        frame_(frame),
        stages_(plan_constants<single_precision::Stages>(plan)),
        noise_(static_cast<float>(reading_noise(plan))) {}

  /// The four sensels of a pillar after all stages.
  [[nodiscard]] single_precision::Pillar pillar(std::size_t row, std::size_t col) const;

  /// Noise of the four sensels of a pillar after correction, counts.
  [[nodiscard]] single_precision::Noise noise(std::size_t row, std::size_t col) const;

  /// A sensel before calibration: valid, missing or saturated.
  [[nodiscard]] single_precision::Sensel validated(std::size_t row, std::size_t col) const;

  [[nodiscard]] const single_precision::Stages& stages() const { return stages_; }

 private:
  [[nodiscard]] single_precision::Correction correction(std::size_t row, std::size_t col) const;
  [[nodiscard]] single_precision::Sensel sensel(std::size_t row, std::size_t col) const;
  [[nodiscard]] float sensel_noise(std::size_t row, std::size_t col) const;
  [[nodiscard]] float raw(std::size_t row, std::size_t col) const;

  const Calibration& calibration_;
  const FrameView& frame_;
  single_precision::Stages stages_;
  float noise_;  ///< of a raw reading, counts
};

}  // namespace pillarfield
