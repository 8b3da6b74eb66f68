#pragma once

#include <cstddef>

#include "core/pillar_maths.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// A frame's sensels after the stages of a plan, in single precision as on the device. Plan and
/// frame, which fit each other, must outlive it.
class SenselReader {
 public:
  SenselReader(const SolverPlan& plan, const FrameView& frame) : plan_(plan), frame_(frame) {}

  [[nodiscard]] single_precision::Sensel operator()(std::size_t row, std::size_t col) const;

  /// The pillar in this row and column of pillars.
  [[nodiscard]] single_precision::Pillar pillar(std::size_t row, std::size_t col) const;

  /// Noise as it is in the V of a sensel, counts.
  [[nodiscard]] float noise(const single_precision::Sensel& sensel, std::size_t row,
                            std::size_t col) const;

 private:
  [[nodiscard]] float raw(std::size_t row, std::size_t col) const;

  const SolverPlan& plan_;
  const FrameView& frame_;
};

}  // namespace pillarfield
