// The kernels on a device and as C++ with vectors on the host: 0 ULP on every path.

#include "pillarfield/processor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <optional>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

constexpr float kSmallest = std::numeric_limits<float>::denorm_min();

/// Equal within `ulps` units in the last place of `scale`, which is at least |expected|.
void expect_near(float actual, float expected, float scale, float ulps, const char* plane,
                 std::size_t pillar) {
  const float tolerance = ulps * std::max(std::numeric_limits<float>::epsilon() * scale, kSmallest);
  ASSERT_LE(std::abs(actual - expected), tolerance)
      << plane << " of pillar " << pillar << ": " << actual << " is not " << expected;
}

/// Tolerance with library functions before the solve: ULP of the force's magnitude. Where the power
/// law's last bit decides whether readings allow one force or a segment, a GPU may decide
/// otherwise.
void expect_same_forces(const ForceFieldView& actual, const ForceFieldView& expected, float ulps) {
  std::size_t other_decisions = 0;
  for (std::size_t i = 0; i < actual.normal.size(); ++i) {
    const float scale = std::hypot(expected.shear_x[i], expected.shear_y[i], expected.normal[i]);
    expect_near(actual.shear_x[i], expected.shear_x[i], scale, ulps, "shear_x", i);
    expect_near(actual.shear_y[i], expected.shear_y[i], scale, ulps, "shear_y", i);
    expect_near(actual.normal[i], expected.normal[i], scale, ulps, "normal", i);
    if (actual.status[i] != expected.status[i]) ++other_decisions;
    ASSERT_EQ(actual.status[i] | status::kAmbiguous, expected.status[i] | status::kAmbiguous);
  }
  EXPECT_LE(other_decisions, actual.normal.size() / 100);
}

using Path = DevicePath;

std::vector<Path> all_paths() {
  std::vector<Path> paths;
  for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    for (const int lanes : {1, 2, 4, 8, 16}) {
      for (const Memory memory : {Memory::shared, Memory::staged}) {
        paths.push_back({type, lanes, memory});
      }
    }
  }
  return paths;
}

class EveryPath : public OnDevice<Path> {
 protected:
  /// Solves random frames of `plan` and expects the bits of the host.
  static void expect_host_bits(const SolverPlan& plan, std::size_t padding) {
    const Path& path = GetParam();
    Processor processor(test_device(), plan, {.memory = path.memory},
                        {.lanes = tested_lanes(path.lanes)});
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      const RandomFrame frame(plan, padding, seed);
      processor.submit(frame.view());
      expect_same_planes(processor.receive(), solve_on_host(plan, frame.view()).view());
    }
  }
};

/// By default not on all paths, because compiling is slow. The bare solve loads bytes as whole
/// numbers; other loads of bytes are tested here.
class AllStages : public EveryPath {};

/// Stages that need programs of their own.
class OtherStages : public EveryPath {};

TEST_P(EveryPath, BareSolveHasTheBitsOfTheHost) {
  expect_host_bits(bare_plan(34, 2 * 53, GetParam().type), 0);
}

TEST_P(AllStages, HaveTheBitsOfTheHost) {
  expect_host_bits(full_plan(22, 2 * 39, GetParam().type, 7), 0);
}

TEST_P(OtherStages, UncertaintyIsThatOfTheHost) {
  SolverPlan with_uncertainty = full_plan(14, 2 * 21, GetParam().type, 9);
  with_uncertainty.uncertainty = true;
  SolverPlan plain = bare_plan(12, 2 * 19, GetParam().type);
  plain.uncertainty = true;
  plain.noise_counts = 0.7;
  for (const SolverPlan& plan : {with_uncertainty, plain}) expect_host_bits(plan, 3);
}

TEST_P(OtherStages, PaperSolveIsThatOfTheHost) {
  SolverPlan all_stages = full_plan(14, 2 * 21, GetParam().type, 10);
  SolverPlan bare = bare_plan(12, 2 * 37, GetParam().type);
  for (SolverPlan* plan : {&all_stages, &bare}) {
    plan->estimator = Estimator::paper;
    Processor processor(test_device(), *plan, {.memory = GetParam().memory},
                        {.lanes = tested_lanes(GetParam().lanes)});
    const RandomFrame frame(*plan, 0, 2);
    processor.submit(frame.view());
    expect_same_forces(processor.receive(), solve_on_host(*plan, frame.view()).view(), 64);
  }
}

/// A threshold that few random readings exceed: many pillars are untouched.
SolverPlan following_plan(std::uint32_t rows, std::uint32_t cols, SenselType type) {
  SolverPlan plan = full_plan(rows, cols, type, 11);
  const double largest = type == SenselType::u16 ? 4095 : (type == SenselType::u8 ? 255 : 300);
  plan.skin.full_scale_counts = 0.999 * largest;
  plan.skin.threshold_counts = 0.98 * largest;
  plan.calibration.gain.clear();
  plan.baseline_rate = 0.125;
  plan.calibration.noise.clear();  // Random readings then show a drift.
  plan.noise_counts = largest;
  return plan;
}

TEST_P(OtherStages, BaselineFollowsAsOnTheHost) {
  for (const std::uint32_t cols : {2U * 37, 2U * 3 + 1}) {
    SolverPlan plan = following_plan(23, cols, GetParam().type);
    plan.baseline_interval = cols > 7 ? 3 : 1;
    const std::vector<float> before = plan.calibration.tare;
    Processor processor(test_device(), plan, {.memory = GetParam().memory, .frames_in_flight = 3},
                        {.lanes = tested_lanes(GetParam().lanes)});
    ASSERT_EQ(processor.tare(), before) << "making a processor moves the tare";
    HostReference host(plan);
    std::vector<RandomFrame> frames;
    for (std::uint32_t seed = 0; seed < 6; ++seed) frames.emplace_back(plan, 5, seed);
    for (std::size_t first = 0; first < frames.size(); first += 3) {
      for (std::size_t i = first; i < first + 3; ++i) processor.submit(frames[i].view());
      for (std::size_t i = first; i < first + 3; ++i) {
        expect_same_bits(processor.receive(), host.solve(frames[i].view()));
      }
    }
    const std::vector<float> after = host.tare();
    expect_same_bits(processor.tare(), after, "tare");
    for (std::size_t i = 0; i < before.size(); ++i) {
      if (i / cols == 22 || i % cols == 6) continue;  // under no pillar, at odd sizes
      ASSERT_NE(before[i], after[i]) << "neither followed nor drifted";
    }
  }
}

TEST_P(OtherStages, PowerLawIsThatOfTheHost) {
  SolverPlan plan = full_plan(14, 2 * 21, GetParam().type, 12);
  plan.calibration.dead_zone.clear();
  plan.skin.power_law = PowerLaw{0.8, 100};
  plan.uncertainty = true;
  expect_host_bits(plan, 0);
}

TEST_P(AllStages, OfOddAndStridedFramesHaveTheBitsOfTheHost) {
  expect_host_bits(full_plan(9, 2 * 21 + 1, GetParam().type, 8), 11);
}

TEST_P(EveryPath, OddAndStridedBareFramesHaveTheBitsOfTheHost) {
  expect_host_bits(bare_plan(9, 2 * 21 + 1, GetParam().type), 11);
}

TEST_P(EveryPath, SmallestSkinHasTheBitsOfTheHost) {
  expect_host_bits(bare_plan(2, 2, GetParam().type), 0);
  expect_host_bits(bare_plan(3, 3, GetParam().type), 2);
}

INSTANTIATE_TEST_SUITE_P(Paths, EveryPath, testing::ValuesIn(all_paths()), name_of_path);
INSTANTIATE_TEST_SUITE_P(FurtherPaths, AllStages, testing::ValuesIn(all_paths()), name_of_path);
// Oclgrind runs the staged ones.
INSTANTIATE_TEST_SUITE_P(Paths, AllStages,
                         testing::Values(Path{SenselType::u8, 2, Memory::shared},
                                         Path{SenselType::u8, 4, Memory::staged},
                                         Path{SenselType::u8, 8, Memory::shared},
                                         Path{SenselType::u8, 16, Memory::staged},
                                         Path{SenselType::u16, 1, Memory::staged},
                                         Path{SenselType::f32, 16, Memory::shared}),
                         name_of_path);
INSTANTIATE_TEST_SUITE_P(Paths, OtherStages,
                         testing::Values(Path{SenselType::u8, 16, Memory::staged},
                                         Path{SenselType::u16, 8, Memory::staged},
                                         Path{SenselType::f32, 1, Memory::shared}),
                         name_of_path);
INSTANTIATE_TEST_SUITE_P(FurtherPaths, OtherStages,
                         testing::Values(Path{SenselType::u8, 1, Memory::shared},
                                         Path{SenselType::u16, 2, Memory::staged},
                                         Path{SenselType::f32, 4, Memory::shared},
                                         Path{SenselType::f32, 16, Memory::staged}),
                         name_of_path);

TEST(Processor, EverySizeUpToTwiceTheLanesIsSolved) {
  for (std::uint32_t cols = 2; cols <= 70; ++cols) {
    const SolverPlan plan = bare_plan(5, cols, SenselType::u8);
    Processor processor(test_device(), plan);
    const RandomFrame frame(plan, cols % 3, cols);
    processor.submit(frame.view());
    expect_same_bits(processor.receive(), solve_on_host(plan, frame.view()).view());
  }
}

/// The host solves a single column of pillars as two, the second absent.
TEST(Processor, ASingleColumnHasTheBitsOfTheHost) {
  for (const auto& [cols, layout] :
       {std::pair{2U, SkinLayout::pillars}, {3U, SkinLayout::pillars}, {2U, SkinLayout::sensels}}) {
    SolverPlan plan = full_plan(16, cols, SenselType::u16, 3);
    plan.skin.layout = layout;
    plan.skin.threshold_counts = 100;
    plan.uncertainty = true;
    plan.baseline_rate = 0.1;
    SensorEffects& effects = plan.calibration.effects;
    effects.sensel_leak = {0.05, 0.05};
    effects.wires = {16, 24, 1e-6, 2e-6, 1.5e-6};
    effects.memory = {{{0, 0.05}, {300, 0.04}}, {{0.05, 0.03}}};
    plan.angles = layout == SkinLayout::pillars;
    if (plan.angles) {
      effects.pillar_leak = {0.02, 0.005};
      effects.arm_mm = 0.4;
    } else {
      plan.parity_tolerance_counts.reset();
    }
    HostReference host(plan);
    Processor processor(test_device(), plan);
    for (std::uint32_t seed = 0; seed < 6; ++seed) {
      const RandomFrame touched(plan, 0, seed);
      const FrameBuffer idle(SenselType::u16, 16, cols);
      const FrameView frame = seed % 3 == 2 ? idle.view() : touched.view();
      processor.submit(frame);
      expect_same_planes(processor.receive(), host.solve(frame));
      const std::vector<float> tare = processor.tare();
      const std::vector<float> expected = host.tare();
      for (std::size_t i = 0; i < tare.size(); ++i) {
        if (i % cols == 2) continue;  // under no pillar
        ASSERT_EQ(tare[i], expected[i]) << i;
      }
    }
  }
}

TEST(Processor, FramesInFlightComeBackInTheirOrder) {
  const SolverPlan plan = bare_plan(64, 64, SenselType::u8);
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    Processor processor(test_device(), plan, {.memory = memory, .frames_in_flight = 3});
    std::vector<RandomFrame> frames;
    for (std::uint32_t seed = 0; seed < 9; ++seed) frames.emplace_back(plan, 0, seed);
    std::size_t received = 0;
    for (const RandomFrame& frame : frames) {
      if (processor.in_flight() == 3) {
        const ForceField expected = solve_on_host(plan, frames[received++].view());
        expect_same_bits(processor.receive(), expected.view());
      }
      processor.submit(frame.view());
    }
    while (processor.in_flight() > 0) {
      const ForceField expected = solve_on_host(plan, frames[received++].view());
      expect_same_bits(processor.receive(), expected.view());
    }
    EXPECT_EQ(received, frames.size());
  }
}

TEST(Processor, StagedFramesMayChangeAfterSubmit) {
  const SolverPlan plan = bare_plan(64, 64, SenselType::u8);
  Processor processor(test_device(), plan, {.memory = Memory::staged});
  FrameBuffer frame(SenselType::u8, 64, 64);
  std::memset(frame.bytes().data(), 100, frame.bytes().size());
  const ForceField expected = solve_on_host(plan, frame.view());
  processor.submit(frame.view());
  std::memset(frame.bytes().data(), 7, frame.bytes().size());
  expect_same_bits(processor.receive(), expected.view());
}

TEST(Processor, FrameBuffersAreSolvedInPlaceAndMayOutliveIt) {
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    for (const std::uint32_t cols : {94U, 7U}) {  // 7: sensels of the last pillars are missing
      const SolverPlan plan = bare_plan(32, cols, SenselType::u16);
      std::vector<FrameBuffer> frames;
      {
        Processor processor(test_device(), plan, {.memory = memory});
        for (int i = 0; i < 2; ++i) frames.push_back(processor.frame_buffer());
        EXPECT_TRUE(
            std::ranges::all_of(frames[0].bytes(), [](auto at) { return at == std::byte{}; }));
        for (std::uint32_t seed = 0; seed < 6; seed += 2) {
          const std::array given = {RandomFrame(plan, 0, seed), RandomFrame(plan, 0, seed + 1)};
          for (std::size_t i = 0; i < 2; ++i) {
            copy_readings(given.at(i).view(), frames[i].bytes().data());
            processor.submit(frames[i].view());
          }
          for (const RandomFrame& frame : given) {
            expect_same_bits(processor.receive(), solve_on_host(plan, frame.view()).view());
          }
        }
      }
      std::jthread([&] { frames.clear(); }).join();
    }
  }
}

TEST(Processor, SharedMemoryIsReadInPlace) {
  if (!test_device().info().shares_memory) GTEST_SKIP() << "the device does not share memory";
  const SolverPlan plan = bare_plan(64, 64, SenselType::u8);
  Processor processor(test_device(), plan, {.memory = Memory::shared, .frames_in_flight = 1});
  FrameBuffer frame(SenselType::u8, 64, 64);
  processor.submit(frame.view());
  const float* const place = processor.receive().normal.data();
  for (const int reading : {10, 200}) {
    std::memset(frame.bytes().data(), reading, frame.bytes().size());
    processor.submit(frame.view());
    const ForceFieldView forces = processor.receive();
    EXPECT_EQ(forces.normal.data(), place) << "the result moved";
    EXPECT_FLOAT_EQ(forces.normal[0], static_cast<float>(reading) / 320);
  }
}

TEST(Processor, AProcessorMayBeDestroyedWhileFramesAreInFlight) {
  const SolverPlan plan = bare_plan(512, 512, SenselType::u8);
  const RandomFrame frame(plan, 0, 1);
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    Processor processor(test_device(), plan, {.memory = memory});
    processor.submit(frame.view());
    processor.submit(frame.view());
    Processor moved = std::move(processor);
    EXPECT_EQ(moved.in_flight(), 2);
  }
}

TEST(Processor, RefusesFramesAndPlansThatDoNotFit) {
  SolverPlan plan = bare_plan(8, 8, SenselType::u8);
  Processor processor(test_device(), plan);
  const RandomFrame frame(plan, 0, 1);
  FrameView view = frame.view();
  view.rows = 7;
  EXPECT_THROW(processor.submit(view), Error);
  EXPECT_EQ(processor.in_flight(), 0);
  EXPECT_THROW(Processor(test_device(), plan, {.frames_in_flight = 0}), Error);
  EXPECT_THROW(Processor(test_device(), plan, {}, {.lanes = 3}), Error);
  plan.segment_point = 0;
  EXPECT_THROW(Processor(test_device(), plan), Error);
}

/// Frames after a new plan solve as on a processor that has it from the start, idle blocks, bending
/// and hysteresis included; one in flight keeps the plan before, and so does a pinned one.
TEST(SetPlan, EqualsAProcessorOfThatPlan) {
  for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    SolverPlan bare = bare_plan(64, 94, type);
    bare.calibration.tare.assign(bare.skin.sensels(), 0);
    bare.uncertainty = true;
    bare.noise_counts = 1;
    SolverPlan full = full_plan(64, 94, type, 5);
    full.calibration.effects.memory.emplace().plays = {{.width_counts = 3, .weight = 0.2}};
    for (const SolverPlan& before : {bare, full}) {
      SolverPlan after = before;
      after.skin.threshold_counts = 7.25;
      std::vector<float>& tare = after.calibration.tare;
      for (std::size_t i = 0; i < tare.size(); ++i) tare[i] += i % 3 == 0 ? 9.5F : 2.5F;
      after.calibration.noise.assign(before.skin.sensels(), 2.5F);
      after.calibration.mask.assign(before.skin.sensels(), kGood);
      after.calibration.mask[5] = after.calibration.mask[3000] = kMissing;
      for (const char* const device : {"host", "opencl"}) {
        Processor changed(open_device(device), before);
        Processor first(open_device(device), before);
        Processor second(open_device(device), after);
        const FrameBuffer idle(type, 64, 94);
        for (int i = 0; i < 4; ++i) {  // Both slots have idle blocks.
          Processor& each = i % 2 == 0 ? changed : first;
          each.submit(idle.view());
          static_cast<void>(each.receive());
        }
        for (std::uint32_t seed = 1; seed < 5; ++seed) {
          const RandomFrame random(before, 0, seed);
          const FrameView frame = seed == 3 ? idle.view() : random.view();
          Processor& expected = seed == 1 ? first : second;
          changed.submit(frame);
          if (seed == 1) changed.set_plan(after);
          expected.submit(frame);
          expect_same_bits(changed.receive(), expected.receive());
        }
        EXPECT_EQ(changed.tare(), tare);
      }
    }
  }
}

TEST(SetPlan, RefusesOtherFramesAndPlansWithoutTare) {
  SolverPlan plan = bare_plan(8, 8, SenselType::u8);
  SolverPlan tared = plan;
  tared.calibration.tare.assign(64, 1);
  EXPECT_THROW(Processor(test_device(), plan).set_plan(tared), Error);
  Processor processor(test_device(), tared);
  EXPECT_THROW(processor.set_plan(plan), Error);
  SolverPlan wrong = tared;
  wrong.calibration.tare.pop_back();
  EXPECT_THROW(processor.set_plan(wrong), Error);
  wrong = tared;
  wrong.calibration.tare[7] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(processor.set_plan(wrong), Error);
  wrong = tared;
  wrong.sensel_type = SenselType::f32;
  EXPECT_THROW(processor.set_plan(wrong), Error);
  EXPECT_EQ(processor.tare(), tared.calibration.tare);
}

TEST(TryReceive, GivesEachFrameOnceItIsSolved) {
  const SolverPlan plan = bare_plan(64, 94, SenselType::u8);
  Processor processor(test_device(), plan);
  EXPECT_FALSE(processor.try_receive());
  for (std::uint32_t seed = 1; seed < 20; ++seed) {
    const RandomFrame frame(plan, 0, seed);
    processor.submit(frame.view());
    std::optional<ForceFieldView> forces;
    while (!forces) forces = processor.try_receive();
    expect_same_bits(*forces, solve_on_host(plan, frame.view()).view());
    EXPECT_FALSE(processor.try_receive());
  }
}

}  // namespace
}  // namespace pillarfield
