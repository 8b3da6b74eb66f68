// All speed paths give the bits of the host, over frames in which contacts appear and vanish.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/host_reference.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

/// Frames of an idle skin with one moving contact, which is absent at times.
class MovingContact {
 public:
  MovingContact(const SolverPlan& plan, std::uint32_t seed) : plan_(plan), random_(seed) {}

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
        const double contact = pressed && distance < 9 ? uniform(0, 230) : 0;
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
