// The C++ baselines equal the solve on the host bit for bit.

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "bench/baselines/agreement.h"
#include "bench/baselines/loop_solver.h"
#include "bench/baselines/plain_loop.h"
#include "bench/baselines/vectorised.h"
#include "bench/frames.h"
#include "bench/variants.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"

namespace pillarfield::bench {
namespace {

struct Baseline {
  std::string name;
  SolveRows solve_rows;
};

/// All baselines that this processor can run.
std::vector<Baseline> baselines() {
  std::vector<Baseline> all = {{"plain", solve_rows_plainly}};
  for (const Vectorised& each : vectorised()) {
    all.push_back({each.instructions, each.cached});
    all.push_back({std::string(each.instructions) + "_streaming", each.streaming});
  }
  return all;
}

SolverPlan small_plan(std::uint32_t rows, std::uint32_t cols, double threshold) {
  SolverPlan plan;
  plan.skin.rows = rows;
  plan.skin.cols = cols;
  plan.skin.threshold_counts = threshold;
  return plan;
}

/// Random bytes, many of them small, so that all patterns of usable sensels occur.
FrameBuffer random_frame(const Skin& skin, std::uint32_t seed) {
  std::mt19937 random(seed);
  FrameBuffer frame(SenselType::u8, skin.rows, skin.cols);
  for (std::uint8_t& reading : frame.readings<std::uint8_t>()) {
    const auto value = static_cast<std::uint8_t>(random());
    reading = random() % 2 == 0 ? value : value % 12;
  }
  return frame;
}

class EveryBaseline : public testing::TestWithParam<Baseline> {
 protected:
  static void expect_host_bits(const SolverPlan& plan, const FrameView& frame, int threads = 1) {
    LoopSolver solver(plan, GetParam().solve_rows, threads);
    const ForceField expected = solve_on_host(plan, frame);
    EXPECT_NO_THROW(require_same_bits(GetParam().name, solver.solve(frame), expected.view()));
  }
};

TEST_P(EveryBaseline, SolvesFramesOfAllRegions) {
  for (const Touch touch : {Touch::mixed, Touch::worst, Touch::idle}) {
    const SolverPlan plan = bare_plan(131);
    const Frames frames(plan.skin, plan.sensel_type, {touch, 1});
    for (std::size_t i = 0; i < 3; ++i) expect_host_bits(plan, frames[i]);
  }
}

TEST_P(EveryBaseline, SolvesSkinsOfEveryWidth) {
  for (std::uint32_t cols = 2; cols <= 300; ++cols) {
    const SolverPlan plan = small_plan(7, cols, 0);
    expect_host_bits(plan, random_frame(plan.skin, cols).view());
  }
}

/// Threshold and margin decide the status of pillars with inactive sensels.
TEST_P(EveryBaseline, SolvesWithThresholdAndNoise) {
  for (const double threshold : {1.0, 5.0, 11.0, 200.0, 254.0}) {
    for (const double noise : {-1.0, 0.0, 0.4, 3.0, 1000.0}) {
      SolverPlan plan = small_plan(60, 401, threshold);
      if (noise >= 0) plan.noise_counts = noise;
      const auto seed = static_cast<std::uint32_t>(threshold + noise + 1);
      expect_host_bits(plan, random_frame(plan.skin, seed).view());
    }
  }
}

TEST_P(EveryBaseline, ThreadsShareTheRows) {
  const SolverPlan plan = small_plan(2 * 11, 2 * 70, 0);
  const FrameBuffer frame = random_frame(plan.skin, 5);
  for (const int threads : {2, 3, 16}) expect_host_bits(plan, frame.view(), threads);
}

TEST_P(EveryBaseline, RunSolvesFrameAfterFrame) {
  const SolverPlan plan = bare_plan(50);
  const Frames frames(plan.skin, plan.sensel_type, {});
  LoopSolver solver(plan, GetParam().solve_rows, 2);
  solver.run(frames, 5);
  solver.run(frames, 6);
  const ForceField expected = solve_on_host(plan, frames[10]);
  EXPECT_NO_THROW(require_same_bits(GetParam().name, solver.last(), expected.view()));
}

INSTANTIATE_TEST_SUITE_P(Baselines, EveryBaseline, testing::ValuesIn(baselines()),
                         [](const auto& baseline) { return baseline.param.name; });

TEST(Vectorised, TakesWholeThresholdsOnly) {
  EXPECT_NO_THROW(require_whole_threshold(bare_solve(small_plan(2, 2, 3))));
  EXPECT_THROW(require_whole_threshold(bare_solve(small_plan(2, 2, 2.5))), Error);
  EXPECT_THROW(require_whole_threshold(bare_solve(small_plan(2, 2, 256))), Error);
}

TEST(BareSolve, RefusesOtherPlans) {
  for (const std::string_view stage : stage_names()) {
    SolverPlan plan = bare_plan(4);
    add_stage(plan, stage);
    if (stage == "none") {
      EXPECT_NO_THROW(bare_solve(plan));
    } else {
      EXPECT_THROW(bare_solve(plan), Error) << stage;
    }
  }
  EXPECT_THROW(bare_solve(bare_plan(4, SenselType::u16)), Error);
}

TEST(Agreement, NoticesASingleBit) {
  const SolverPlan plan = small_plan(20, 20, 0);
  const FrameBuffer frame = random_frame(plan.skin, 1);
  const ForceField ours = solve_on_host(plan, frame.view());
  ForceField theirs = ours;
  EXPECT_NO_THROW(require_same_bits("it", theirs.view(), ours.view()));
  EXPECT_NO_THROW(require_near("it", theirs.view(), ours.view(), 0));
  theirs.normal[77] = std::nextafter(theirs.normal[77], 1.0F);
  EXPECT_THROW(require_same_bits("it", theirs.view(), ours.view()), Error);
  EXPECT_THROW(require_near("it", theirs.view(), ours.view(), 0), Error);
  EXPECT_NO_THROW(require_near("it", theirs.view(), ours.view(), 1e-6F));
  theirs = ours;
  theirs.status[99] ^= 1;
  EXPECT_THROW(require_same_bits("it", theirs.view(), ours.view()), Error);
  EXPECT_THROW(require_near("it", theirs.view(), ours.view(), 1), Error);
}

}  // namespace
}  // namespace pillarfield::bench
