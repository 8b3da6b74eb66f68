#include "bench/opponents/loop_solver.h"

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
    : skin_(plan.skin), solve_(bare_solve(plan)), solve_rows_(solve_rows), team_(threads) {
  for (std::size_t i = 0; i < kResults; ++i) results_.emplace_back(skin_);
}

void LoopSolver::run(const Frames& frames, int count) {
  const std::size_t first = solved_;
  const std::size_t last = first + static_cast<std::size_t>(count);
  team_.run([&](int member) {
    for (std::size_t i = first; i < last; ++i) {
      solve_share(frames[i], results_[i % kResults].planes(), member);
      team_.meet();
    }
  });
  solved_ = last;
}

ForceFieldView LoopSolver::solve(const FrameView& frame) {
  const ForcePlanes to = results_[solved_ % kResults].planes();
  team_.run([&](int member) { solve_share(frame, to, member); });
  ++solved_;
  return last();
}

ForceFieldView LoopSolver::last() const {
  return results_[(solved_ + kResults - 1) % kResults].view(skin_);
}

void LoopSolver::solve_share(const FrameView& frame, const ForcePlanes& to, int member) const {
  const auto before = [&](int members) {
    return static_cast<std::uint32_t>(std::uint64_t{skin_.pillar_rows()} *
                                      static_cast<std::uint64_t>(members) /
                                      static_cast<std::uint64_t>(team_.members()));
  };
  solve_rows_(solve_, frame, before(member), before(member + 1), to);
}

}  // namespace pillarfield::bench
