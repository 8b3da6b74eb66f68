// All speed paths give the bits of the host, over frames in which contacts appear and vanish.

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

/// Frames of an idle skin with one moving contact, which is absent at times. Its readings are
/// uniform from `lowest` to 230 counts; those below zero are lifted sensels.
class MovingContact {
 public:
  MovingContact(const SolverPlan& plan, std::uint32_t seed, double lowest = 0)
      : plan_(plan), random_(seed), lowest_(lowest) {}

  FrameBuffer next() {
    const Skin& skin = plan_.skin;
    FrameBuffer frame(plan_.sensel_type, skin.rows, skin.cols);
    const bool pressed = frame_ % 4 != 3;
    const double center_row = uniform(0, skin.rows);
    const double center_col = uniform(0, skin.cols);
    for (std::size_t row = 0; row < skin.rows; ++row) {
      for (std::size_t col = 0; col < skin.cols; ++col) {
        const std::size_t at = row * skin.cols + col;
        const double distance = std::hypot(static_cast<double>(row) - center_row,
                                           static_cast<double>(col) - center_col);
        const double contact = pressed && distance < 9 ? uniform(lowest_, 230) : 0;
        const float tare = plan_.calibration.tare.empty() ? 0 : plan_.calibration.tare[at];
        write(frame, at, std::max(0.0, tare + uniform(-1, 1.5) + contact));
      }
    }
    ++frame_;
    return frame;
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  void write(FrameBuffer& frame, std::size_t at, double reading) {
    switch (plan_.sensel_type) {
      case SenselType::u8:
        frame.readings<std::uint8_t>()[at] = static_cast<std::uint8_t>(std::min(reading, 255.0));
        return;
      case SenselType::u16:
        frame.readings<std::uint16_t>()[at] = static_cast<std::uint16_t>(reading);
        return;
      case SenselType::f32:
        break;
    }
    // Sometimes a sensel or its converter fails.
    constexpr float kAbsurd[] = {std::numeric_limits<float>::quiet_NaN(), -1e38F, 1e38F};
    const double kind = uniform(0, 1);
    frame.readings<float>()[at] = kind < 0.998
                                      ? static_cast<float>(reading)
                                      : kAbsurd[static_cast<std::size_t>(uniform(0, 2.999))];
  }

  const SolverPlan& plan_;
  std::mt19937 random_;
  double lowest_;
  int frame_ = 0;
};

/// Solves frames, two in flight, so that slots alternate.
void expect_host_bits(const SolverPlan& plan, int lanes, const SpeedPaths& paths,
                      Memory memory = Memory::automatic) {
  HostReference host(plan);
  Processor processor(test_device(), plan, {.memory = memory, .frames_in_flight = 2},
                      {.lanes = tested_lanes(lanes), .paths = paths});
  MovingContact contact(plan, 5);
  for (int i = 0; i < 14; ++i) {
    SCOPED_TRACE(i);
    const FrameBuffer frame = contact.next();
    processor.submit(frame.view());
    expect_same_planes(processor.receive(), host.solve(frame.view()));
    if (testing::Test::HasFatalFailure()) return;
  }
  expect_same_bits(processor.tare(), host.tare(), "tare");
}

/// The noise of MovingContact stays below every threshold.
SolverPlan quiet_plan(std::uint32_t rows, std::uint32_t cols, SenselType type) {
  SolverPlan plan = full_plan(rows, cols, type, 3);
  for (float& tare : plan.calibration.tare) tare = std::abs(tare);
  plan.angles = true;
  plan.uncertainty = true;
  return plan;
}

struct SpeedPath {
  SenselType type;
  int lanes;
};

class SpeedPathTest : public testing::TestWithParam<SpeedPath> {};

TEST_P(SpeedPathTest, SkippingIdleBlocksChangesNoBit) {
  expect_host_bits(quiet_plan(40, 2 * 53, GetParam().type), GetParam().lanes,
                   {.skip_idle = true, .stores = Stores::cached});
}

TEST_P(SpeedPathTest, StoresPastTheCachesChangeNoBit) {
  expect_host_bits(quiet_plan(40, 2 * 53, GetParam().type), GetParam().lanes,
                   {.skip_idle = false, .stores = Stores::streaming});
}

TEST_P(SpeedPathTest, BothTogetherWithACopyOfTheResultsChangeNoBit) {
  SolverPlan plan = bare_plan(44, 2 * 39, GetParam().type);
  plan.skin.threshold_counts = 3;
  expect_host_bits(plan, GetParam().lanes, {.skip_idle = true, .stores = Stores::streaming},
                   Memory::staged);
}

TEST_P(SpeedPathTest, IdleBlocksFollowTheTare) {
  SolverPlan plan = quiet_plan(40, 2 * 37, GetParam().type);
  plan.angles = plan.uncertainty = false;
  plan.baseline_rate = 0.3;
  for (const int interval : {1, 3, 64}) {  // 64: more than there are rows
    plan.baseline_interval = interval;
    expect_host_bits(plan, GetParam().lanes, {.skip_idle = true});
  }
}

std::string name_of_path(const testing::TestParamInfo<SpeedPath>& path) {
  return std::string(name_of(path.param.type)) + "_lanes" + std::to_string(path.param.lanes);
}

INSTANTIATE_TEST_SUITE_P(Paths, SpeedPathTest,
                         testing::Values(SpeedPath{SenselType::u8, 16},
                                         SpeedPath{SenselType::u16, 8},
                                         SpeedPath{SenselType::f32, 2}),
                         name_of_path);
INSTANTIATE_TEST_SUITE_P(FurtherPaths, SpeedPathTest,
                         testing::Values(SpeedPath{SenselType::u8, 1},
                                         SpeedPath{SenselType::f32, 16}),
                         name_of_path);

/// Frames that change few, all, or no results, so that results travel as expected groups, with
/// a second read, and as whole planes; three in flight.
void expect_host_bits_of_packed_results(const SolverPlan& plan) {
  HostReference host(plan);
  Processor processor(test_device(), plan, {.memory = Memory::staged, .frames_in_flight = 3});
  MovingContact contact(plan, 9, -60);  // many pillars are ambiguous
  const FrameBuffer idle(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  const RandomFrame dense[] = {{plan, 0, 1}, {plan, 3, 2}};
  const FrameBuffer still = contact.next();
  std::deque<FrameBuffer> moving;
  std::deque<FrameView> frames;
  for (std::size_t i = 0; i < 54; ++i) {
    const std::size_t phase = i % 27;  // nine frames, three of each slot
    FrameView frame = dense[i % 2].view();
    if (phase < 9) frame = moving.emplace_back(contact.next()).view();
    if (phase >= 18) frame = i < 27 ? idle.view() : still.view();
    processor.submit(frame);
    frames.push_back(frame);
    if (processor.in_flight() < 3) continue;
    SCOPED_TRACE(i);
    std::optional<ForceFieldView> forces;
    while (i % 2 == 0 && !forces) forces = processor.try_receive();
    if (!forces) forces = processor.receive();
    expect_same_planes(*forces, host.solve(frames.front()));
    if (testing::Test::HasFatalFailure()) return;
    frames.pop_front();
  }
}

TEST(PackedResults, HaveTheBitsOfTheHost) {
  for (const SkinLayout layout : {SkinLayout::pillars, SkinLayout::sensels}) {
    for (const auto& [rows, cols] : {std::pair{121U, 195U}, {300U, 6U}}) {
      SolverPlan plan = bare_plan(rows, cols, SenselType::u8);
      plan.skin.threshold_counts = 3;
      plan.skin.layout = layout;
      plan.uncertainty = true;
      plan.noise_counts = 0.7;
      plan.angles = layout == SkinLayout::pillars;
      plan.calibration.mask.assign(plan.skin.sensels(), kGood);
      plan.calibration.mask[7] = plan.calibration.mask[900] = kMissing;
      expect_host_bits_of_packed_results(plan);
      if (!plan.angles) continue;
      plan.estimator = Estimator::contact;  // which resolves pillars in the planes received
      expect_host_bits_of_packed_results(plan);
      plan.calibration.effects.pillar_leak = {0.02, 0.005};
      plan.calibration.effects.arm_mm = 0.4;
      expect_host_bits_of_packed_results(plan);
    }
  }
}

/// Idle blocks are skipped, by the host always: a value written into their results stays.
TEST(SpeedPaths, AnIdleBlockIsNotWrittenAgain) {
  if (!test_device().info().shares_memory) GTEST_SKIP() << "the device does not share memory";
  SolverPlan plan = bare_plan(8, 2 * 64, SenselType::u8);
  plan.skin.threshold_counts = 3;
  for (const bool skip : {true, false}) {
    Processor processor(test_device(), plan, {.frames_in_flight = 1},
                        {.paths = {.skip_idle = skip}});
    FrameBuffer frame(SenselType::u8, plan.skin.rows, plan.skin.cols);
    processor.submit(frame.view());
    const ForceFieldView forces = processor.receive();
    const_cast<float&>(forces.normal[5]) = 42;  // Breaks the contract, to detect a write.
    processor.submit(frame.view());
    const bool skips = skip || test_device().info().type == "host";
    EXPECT_EQ(processor.receive().normal[5], skips ? 42.0F : 0.0F);
  }
}

}  // namespace
}  // namespace pillarfield
