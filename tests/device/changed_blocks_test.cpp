// A processor that solves only changed blocks gives the bits of one that solves whole frames, after
// any sequence of changes.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "pillarfield/error.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "same_bits.h"
#include "test_device.h"

namespace pillarfield {
namespace {

/// Overwrites up to three random rectangles of a frame, some with readings of an idle skin, and
/// names them.
class RandomChanges {
 public:
  explicit RandomChanges(const SolverPlan& plan) : plan_(plan) {}

  std::vector<SenselBlock> apply(FrameBuffer& frame) {
    std::vector<SenselBlock> changed;
    for (std::uint32_t i = below(4); i > 0; --i) {
      const SenselBlock block = random_block();
      const bool idle = below(3) == 0;
      for (std::uint32_t row = 0; row < block.rows; ++row) {
        for (std::uint32_t col = 0; col < block.cols; ++col) {
          const std::size_t at = (block.first_row + row) * plan_.skin.cols + block.first_col + col;
          write(frame, at, idle ? 0 : below(250));
        }
      }
      changed.push_back(block);
    }
    return changed;
  }

 private:
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_()) % end; }

  /// At most 9 x 9, often at a border.
  SenselBlock random_block() {
    const auto place = [this](std::uint32_t all) {
      const std::uint32_t count = below(10);
      const std::uint32_t first[] = {0, all - count, below(all - count + 1)};
      return std::pair(first[below(3)], count);
    };
    const auto [first_row, rows] = place(plan_.skin.rows);
    const auto [first_col, cols] = place(plan_.skin.cols);
    return {first_row, rows, first_col, cols};
  }

  void write(FrameBuffer& frame, std::size_t at, std::uint32_t reading) const {
    switch (plan_.sensel_type) {
      case SenselType::u8:
        frame.readings<std::uint8_t>()[at] = static_cast<std::uint8_t>(reading);
        return;
      case SenselType::u16:
        frame.readings<std::uint16_t>()[at] = static_cast<std::uint16_t>(reading);
        return;
      case SenselType::f32:
        frame.readings<float>()[at] = static_cast<float>(reading);
    }
  }

  const SolverPlan& plan_;
  std::mt19937 random_{11};
};

void expect_same_planes(const ForceFieldView& actual, const ForceFieldView& expected) {
  expect_same_bits(actual, expected);
  expect_same_bits(actual.magnitude, expected.magnitude, "magnitude");
  expect_same_bits(actual.theta, expected.theta, "theta");
  expect_same_bits(actual.phi, expected.phi, "phi");
  for (std::size_t plane = 0; plane < kUncertaintyPlanes; ++plane) {
    const auto which = static_cast<Uncertainty>(plane);
    expect_same_bits(actual.uncertainty[which], expected.uncertainty[which], name_of(which));
  }
}

struct Case {
  SenselType type = SenselType::u8;
  int lanes = 16;
  int in_flight = 1;
  Memory memory = Memory::automatic;
};

void expect_same_as_whole(const SolverPlan& plan, const Case& run) {
  Processor whole(test_device(), plan, {.frames_in_flight = 1}, {.lanes = run.lanes});
  Processor parts(test_device(), plan,
                  {.memory = run.memory, .frames_in_flight = run.in_flight, .changes = true},
                  {.lanes = run.lanes});
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  RandomChanges changes(plan);
  for (int i = 0; i < 60; ++i) {
    const std::vector<SenselBlock> changed = changes.apply(frame);
    whole.submit(frame.view());
    if (i % 20 == 7) {
      parts.submit(frame.view());
    } else {
      parts.submit(frame.view(), changed);
    }
    expect_same_planes(parts.receive(), whole.receive());
    if (testing::Test::HasFatalFailure()) FAIL() << "frame " << i;
  }
}

SolverPlan outputs_on(SolverPlan plan) {
  plan.angles = true;
  plan.uncertainty = true;
  return plan;
}

SolverPlan with_neighbours(SolverPlan plan, bool sensel_leak, bool pillar_leak, bool arm) {
  SensorEffects& effects = plan.calibration.effects;
  if (sensel_leak) effects.sensel_leak = {0.05, 0.02};
  if (pillar_leak) effects.pillar_leak = {0.03, 0.01};
  if (arm) effects.arm_mm = 0.4;
  return plan;
}

class ChangedBlocks : public testing::TestWithParam<Case> {
 protected:
  [[nodiscard]] static SolverPlan plan() { return full_plan(46, 2 * 53 + 1, GetParam().type, 3); }
};

TEST_P(ChangedBlocks, OfABareSolveGiveTheBitsOfTheWholeFrame) {
  SolverPlan bare = bare_plan(45, 2 * 39, GetParam().type);
  bare.skin.threshold_counts = 3;
  expect_same_as_whole(bare, GetParam());
}

TEST_P(ChangedBlocks, OfAFullPlanGiveTheBitsOfTheWholeFrame) {
  expect_same_as_whole(outputs_on(plan()), GetParam());
}

TEST_P(ChangedBlocks, GiveTheBitsOfTheWholeFrameWhereNeighboursAreRead) {
  expect_same_as_whole(with_neighbours(outputs_on(plan()), true, true, true), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Runs, ChangedBlocks,
                         testing::Values(Case{}, Case{SenselType::u8, 1, 2},
                                         Case{SenselType::u16, 8, 3},
                                         Case{SenselType::f32, 16, 2, Memory::staged}),
                         [](const auto& run) {
                           return std::string(name_of(run.param.type)) + "_lanes" +
                                  std::to_string(run.param.lanes) + "_slots" +
                                  std::to_string(run.param.in_flight);
                         });

TEST(ChangedBlocksOfASkin, GiveTheBitsOfTheWholeFrameWhereOneStageReadsNeighbours) {
  const SolverPlan plan = full_plan(46, 2 * 53 + 1, SenselType::u8, 3);
  expect_same_as_whole(with_neighbours(plan, true, false, false), {});
  expect_same_as_whole(with_neighbours(plan, false, true, false), {});
  expect_same_as_whole(with_neighbours(plan, false, false, true), {});
}

TEST(ChangedBlocksOfASkin, GiveTheBitsOfTheWholeFrameWhereFramesLeaveAMemory) {
  SolverPlan plan = full_plan(46, 2 * 53 + 1, SenselType::u8, 3);
  plan.baseline_rate = 0.3;
  expect_same_as_whole(plan, {});
  plan.baseline_rate.reset();
  plan.calibration.effects.memory = {{{0, 0.05}}, {{0.05, 0.03}}};
  expect_same_as_whole(plan, {});
  SolverPlan touching = bare_plan(46, 2 * 53, SenselType::u8);
  touching.noise_counts = 0.5;
  touching.estimator = Estimator::contact;
  expect_same_as_whole(touching, {});
}

/// Whether the pillar's normal force is written again, by a value that breaks the contract.
bool is_written(const ForceFieldView& forces, std::size_t pillar,
                const std::function<void()>& solve) {
  auto& normal = const_cast<float&>(forces.normal[pillar]);
  normal = 42;
  solve();
  return normal != 42;
}

TEST(ChangedBlocksOfASkin, AreSolvedAloneWithTheRingsThatStagesRead) {
  if (!test_device().info().shares_memory) GTEST_SKIP() << "the device does not share memory";
  for (const bool leaks : {false, true}) {
    const SolverPlan plan =
        with_neighbours(bare_plan(64, 2 * 64, SenselType::u8), leaks, leaks, leaks);
    Processor processor(test_device(), plan, {.frames_in_flight = 1, .changes = true},
                        {.lanes = 16});
    FrameBuffer frame(SenselType::u8, plan.skin.rows, plan.skin.cols);
    std::ranges::fill(frame.readings<std::uint8_t>(), std::uint8_t{100});
    const SenselBlock changed = {32, 8, 64, 8};  // Pillars 16 to 19 down, 32 to 35 across.
    ForceFieldView forces;
    const auto solve = [&] {
      processor.submit(frame.view(), {&changed, 1});
      forces = processor.receive();
    };
    solve();
    const auto written = [&](std::size_t row, std::size_t col) {
      return is_written(forces, row * 64 + col, solve);
    };
    EXPECT_TRUE(written(16, 32) && written(19, 47));
    EXPECT_EQ(written(11, 31), leaks);
    EXPECT_FALSE(written(10, 32) || written(25, 32) || written(16, 15) || written(16, 48));
  }
}

TEST(ChangedBlocksOfASkin, AreAllBlocksAfterANewTare) {
  SolverPlan plan = bare_plan(32, 2 * 32, SenselType::u8);
  plan.calibration.tare.assign(plan.skin.sensels(), 0);
  Processor processor(test_device(), plan, {.frames_in_flight = 1, .changes = true});
  FrameBuffer frame(SenselType::u8, plan.skin.rows, plan.skin.cols);
  std::ranges::fill(frame.readings<std::uint8_t>(), std::uint8_t{100});
  processor.submit(frame.view());
  EXPECT_GT(processor.receive().normal[40], 0);
  processor.set_tare(std::vector<float>(plan.skin.sensels(), 100));
  processor.submit(frame.view(), {});
  EXPECT_EQ(processor.receive().normal[40], 0);
}

TEST(ChangedBlocksOfASkin, BeyondItAreRefused) {
  const SolverPlan plan = bare_plan(32, 2 * 32, SenselType::u8);
  Processor processor(test_device(), plan, {.changes = true});
  const FrameBuffer frame(SenselType::u8, plan.skin.rows, plan.skin.cols);
  for (const SenselBlock block : {SenselBlock{28, 5, 0, 1}, SenselBlock{0, 1, 64, 1},
                                  SenselBlock{0xFFFFFFFF, 2, 0, 1}, SenselBlock{0, 1, 1, ~0U}}) {
    EXPECT_THROW(processor.submit(frame.view(), {&block, 1}), Error);
  }
  Processor whole(test_device(), plan);
  EXPECT_THROW(whole.submit(frame.view(), {}), Error);
}

}  // namespace
}  // namespace pillarfield
