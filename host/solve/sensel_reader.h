#pragma once

#include <cstddef>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "solve/pillar_maths.h"
#include "solve/plan_constants.h"

namespace pillarfield {

/// A frame's sensels after the stages of a plan, in single precision as on the device. Plan and
/// frame, which fit each other, must outlive it.
class SenselReader {
 public:
  SenselReader(const SolverPlan& plan, const FrameView& frame)
      : calibration_(plan.calibration),
        frame_(frame),
        stages_(plan_constants<single_precision::Stages>(plan)),
        noise_(static_cast<float>(reading_noise(plan))) {}

  /// The four of the pillar in this row and column of pillars, after all stages.
  [[nodiscard]] single_precision::Pillar pillar(std::size_t row, std::size_t col) const;

  /// Their noise as the corrections leave it, counts.
  [[nodiscard]] single_precision::Noise noise(std::size_t row, std::size_t col) const;

  /// A sensel before any calibration.
  [[nodiscard]] single_precision::Sensel judged(std::size_t row, std::size_t col) const;

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
