#pragma once

#include <cstddef>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// A frame's sensels after the stages of a plan, in single precision as on the device. Plan and
/// frame, which fit each other, must outlive it.
class SenselReader {
 public:
  SenselReader(const SolverPlan& plan, const FrameView& frame) : plan_(plan), frame_(frame) {}

  /// After all stages.
  [[nodiscard]] single_precision::Sensel operator()(std::size_t row, std::size_t col) const;

  /// The four of the pillar in this row and column of pillars.
  [[nodiscard]] single_precision::Pillar pillar(std::size_t row, std::size_t col) const;

  /// Before any calibration.
  [[nodiscard]] single_precision::Sensel judged(std::size_t row, std::size_t col) const;

  /// Noise as the corrections leave it, counts.
  [[nodiscard]] float noise(std::size_t row, std::size_t col) const;

 private:
  [[nodiscard]] single_precision::Sensel corrected(std::size_t row, std::size_t col) const;
  [[nodiscard]] float exponent() const;
  [[nodiscard]] float reference() const;
  [[nodiscard]] float raw(std::size_t row, std::size_t col) const;

  const SolverPlan& plan_;
  const FrameView& frame_;
};

}  // namespace pillarfield
