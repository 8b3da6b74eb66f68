#pragma once

#include <cstddef>
#include <vector>

#include "base/thread_pool.h"
#include "bench/frames.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// kernels/pillar in double as a C++ loop over the pillars of dense frames, on all threads, for the
/// plans of SolveVariant. It stores results as float in the planes of a processor, alternating
/// between two results. No other code solves fields in double.
class DoubleLoop {
 public:
  /// Throws Error where the plan has a stage that no variant has. `plan` must outlive it.
  DoubleLoop(const SolverPlan& plan, int threads);

  /// Solves the next `count` frames.
  void run(const Frames& frames, int count);

  /// Solves one frame; the result is valid until two more are solved. Angles and uncertainty are
  /// stored, but not returned.
  ForceFieldView solve(const FrameView& frame);

  /// The planes of a result: forces, angles, uncertainty, status.
  using Planes = std::vector<FrameBuffer>;
  /// Solves the rows of pillars from `first` to before `last`.
  using SolveRows = void (*)(const SolverPlan& plan, const void* readings, std::size_t first,
                             std::size_t last, Planes& to);

 private:
  const SolverPlan* plan_;
  SolveRows solve_rows_;
  std::vector<Planes> results_;
  std::size_t solved_ = 0;
  ThreadPool pool_;
};

}  // namespace pillarfield::bench
