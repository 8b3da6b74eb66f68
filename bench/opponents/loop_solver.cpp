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

LoopSolver::LoopSolver(const SolverPlan& plan, SolveRows solve_rows, int threads)
    : skin_(plan.skin), solve_(bare_solve(plan)), solve_rows_(solve_rows), team_(threads) {
  for (int i = 0; i < 2; ++i) results_.emplace_back(skin_);
}

void LoopSolver::run(const Frames& frames, int count) {
  const std::size_t first = solved_;
  const std::size_t last = first + static_cast<std::size_t>(count);
  team_.run([&](int member) {
    for (std::size_t i = first; i < last; ++i) {
      solve_share(frames[i], results_[i % results_.size()].planes(), member);
      team_.meet();
    }
  });
  solved_ = last;
}

ForceFieldView LoopSolver::solve(const FrameView& frame) {
  Result& to = result();
  team_.run([&](int member) { solve_share(frame, to.planes(), member); });
  ++solved_;
  return {skin_.pillar_rows(),
          skin_.pillar_cols(),
          to.shear_x.readings<float>(),
          to.shear_y.readings<float>(),
          to.normal.readings<float>(),
          to.status.readings<std::uint8_t>(),
          {},
          {},
          {},
          {}};
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
