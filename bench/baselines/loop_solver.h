#pragma once

#include <vector>

#include "base/thread_pool.h"
#include "bench/baselines/bare_solve.h"
#include "bench/frames.h"
#include "pillarfield/force_field.h"

namespace pillarfield::bench {

/// A multithreaded C++ loop over frames: threads take piece after piece of a frame. It alternates
/// between two results, as a processor of two slots does.
class LoopSolver {
 public:
  LoopSolver(const SolverPlan& plan, SolveRows solve_rows, int threads);

  /// Solves the next `count` frames.
  void run(const Frames& frames, int count);

  /// Solves one frame; the result is valid until two more are solved.
  ForceFieldView solve(const FrameView& frame);

  /// The result of the last frame.
  [[nodiscard]] ForceFieldView last() const;

 private:
  static constexpr std::size_t kResults = 2;
  static constexpr std::size_t kPieces = 32;  ///< of a frame
  struct Result {
    explicit Result(const Skin& skin);
    ForcePlanes planes();
    [[nodiscard]] ForceFieldView view(const Skin& skin) const;
    FrameBuffer shear_x;  ///< page-aligned, as in a processor
    FrameBuffer shear_y;
    FrameBuffer normal;
    FrameBuffer status;
  };
  template <class FrameOf>
  void solve_frames(std::size_t count, FrameOf frame_of);
  void solve_piece(const FrameView& frame, const ForcePlanes& to, std::size_t piece) const;

  Skin skin_;
  BareSolve solve_;
  SolveRows solve_rows_;
  std::vector<Result> results_;
  std::size_t solved_ = 0;
  std::size_t threads_;
  ThreadPool pool_;
};

}  // namespace pillarfield::bench
