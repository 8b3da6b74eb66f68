#pragma once

#include <optional>

#include "bench/baselines/double_loop.h"
#include "bench/frame_solver.h"
#include "bench/solve_variant.h"

namespace pillarfield::bench {

/// Solves a series of frames by a variant. `plan`, the plan of the variant, and `frames` must
/// outlive it.
class VariantSolver {
 public:
  VariantSolver(const Device& device, const SolveVariant& variant, const SolverPlan& plan,
                const Frames& frames);

  /// Solves the next `frames` frames.
  void run(int frames);

  /// Solves one frame; the result is valid until run() or the next solve().
  ForceFieldView solve(const FrameView& frame);

 private:
  const Frames* frames_;
  std::optional<FrameSolver> on_device_;  ///< exactly one of the two is set
  std::optional<DoubleLoop> in_double_;
};

}  // namespace pillarfield::bench
