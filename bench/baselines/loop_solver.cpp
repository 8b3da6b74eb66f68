#include "bench/baselines/loop_solver.h"

#include <atomic>
#include <barrier>

namespace pillarfield::bench {

LoopSolver::Result::Result(const Skin& skin)
    : shear_x(SenselType::f32, skin.pillar_rows(), skin.pillar_cols()),
      shear_y(SenselType::f32, skin.pillar_rows(), skin.pillar_cols()),
      normal(SenselType::f32, skin.pillar_rows(), skin.pillar_cols()),
      status(SenselType::u8, skin.pillar_rows(), skin.pillar_cols()) {}

ForcePlanes LoopSolver::Result::planes() {
  return {shear_x.readings<float>().data(), shear_y.readings<float>().data(),
          normal.readings<float>().data(), status.readings<std::uint8_t>().data()};
}

ForceFieldView LoopSolver::Result::view(const Skin& skin) const {
  ForceFieldView view;
  view.rows = skin.pillar_rows();
  view.cols = skin.pillar_cols();
  view.shear_x = shear_x.readings<float>();
  view.shear_y = shear_y.readings<float>();
  view.normal = normal.readings<float>();
  view.status = status.readings<std::uint8_t>();
  return view;
}

LoopSolver::LoopSolver(const SolverPlan& plan, SolveRows solve_rows, int threads)
    : skin_(plan.skin),
      solve_(bare_solve(plan)),
      solve_rows_(solve_rows),
      threads_(static_cast<std::size_t>(threads)),
      pool_(threads_) {
  for (std::size_t i = 0; i < kResults; ++i) results_.emplace_back(skin_);
}

template <class FrameOf>
void LoopSolver::solve_frames(std::size_t count, FrameOf frame_of) {
  std::atomic<std::size_t> next = 0;
  std::barrier meeting(static_cast<std::ptrdiff_t>(threads_));
  pool_.run(threads_, [&](std::size_t, std::size_t) {
    // Threads draw the pieces of all frames in order, and wait at the end of each frame.
    std::size_t piece = next++;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t frame = solved_ + i;
      const ForcePlanes to = results_[frame % kResults].planes();
      for (; piece / kPieces == i; piece = next++)
        solve_piece(frame_of(frame), to, piece % kPieces);
      meeting.arrive_and_wait();
    }
  });
  solved_ += count;
}

void LoopSolver::run(const Frames& frames, int count) {
  solve_frames(static_cast<std::size_t>(count), [&](std::size_t i) { return frames[i]; });
}

ForceFieldView LoopSolver::solve(const FrameView& frame) {
  solve_frames(1, [&](std::size_t) { return frame; });
  return last();
}

ForceFieldView LoopSolver::last() const {
  return results_[(solved_ + kResults - 1) % kResults].view(skin_);
}

void LoopSolver::solve_piece(const FrameView& frame, const ForcePlanes& to,
                             std::size_t piece) const {
  const auto row = [&](std::size_t pieces) {
    return static_cast<std::uint32_t>(skin_.pillar_rows() * pieces / kPieces);
  };
  solve_rows_(solve_, frame, row(piece), row(piece + 1), to);
}

}  // namespace pillarfield::bench
