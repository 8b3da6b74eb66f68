#pragma once

#include <optional>

#include "bench/baselines/double_loop.h"
#include "bench/frame_solver.h"
#include "bench/solve_variant.h"

namespace pillarfield::bench {

/// Solves a series of frames as a variant says. `plan`, which is that of the variant, and `frames`
/// must outlive it.
class VariantSolver {
 public:
  VariantSolver(const Device& device, const SolveVariant& variant, const SolverPlan& plan,
                const Frames& frames);

  /// Solves so many frames, going on where it stopped.
  void run(int frames);

  /// Solves one frame; the result stays until run() or the next solve().
  ForceFieldView solve(const FrameView& frame);

 private:
  const Frames* frames_;
  std::optional<FrameSolver> on_device_;  ///< one of the two is there
  std::optional<DoubleLoop> in_double_;
};

}  // namespace pillarfield::bench
