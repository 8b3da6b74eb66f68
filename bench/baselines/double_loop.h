#pragma once

#include <cstddef>
#include <vector>

#include "base/thread_pool.h"
#include "bench/frames.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// kernels/pillar in double as a C++ loop over the pillars of dense frames, on all threads, for the
/// plans of SolveVariant. It stores results as float, in as many planes as a processor does, and
/// keeps two of them in turns. The only place where fields are solved in double.
class DoubleLoop {
 public:
  /// Throws Error where the plan asks for a stage that no variant has. `plan` must outlive it.
  DoubleLoop(const SolverPlan& plan, int threads);

  /// Solves so many frames, going on where it stopped.
  void run(const Frames& frames, int count);

  /// Solves one frame; the result stays until two more are solved. Angles and uncertainty are
  /// computed and stored, but not among what is returned.
  ForceFieldView solve(const FrameView& frame);

  /// The planes of a result: forces, then angles, then uncertainty, then the status.
  using Planes = std::vector<FrameBuffer>;
  /// Solves the rows of pillars from `first` to before `last`.
  using SolveRows = void (*)(const SolverPlan& plan, const void* readings, std::size_t first,
                             std::size_t last, Planes& to);

 private:
  const SolverPlan* plan_;
  SolveRows solve_rows_;
  std::vector<Planes> results_;
  std::size_t solved_ = 0;
  ThreadPool team_;
};

}  // namespace pillarfield::bench
