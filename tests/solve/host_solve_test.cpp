// Errors of the solve on the host.

#include "pillarfield/host_solve.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pillarfield/processor.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

class HostSolve : public testing::Test {
 protected:
  HostSolve() {
    plan_.skin.rows = 4;
    plan_.skin.cols = 6;
    plan_.skin.counts_per_newton = 100;
    plan_.sensel_type = SenselType::u16;
    frame_ = {readings_.data(), SenselType::u16, 4, 6, 8};
  }

  void expect_refused(const char* what) {
    const std::string message = core_test::message_of([&] { (void)solve_on_host(plan_, frame_); });
    EXPECT_NE(message.find(what), std::string::npos) << message;
  }

  SolverPlan plan_;
  std::vector<std::uint16_t> readings_ = std::vector<std::uint16_t>(32, 50);
  FrameView frame_;
};

TEST_F(HostSolve, TakesRowsOfAnyStride) {
  for (std::size_t row = 0; row < 4; ++row) readings_[row * 8 + 6] = readings_[row * 8 + 7] = 999;
  const ForceField forces = solve_on_host(plan_, frame_);
  EXPECT_EQ(forces.normal, std::vector<float>(6, 0.5F));
}

TEST_F(HostSolve, RefusesFramesAndPlansThatDoNotFit) {
  FrameView fitting = frame_;
  frame_.rows = 6;
  expect_refused("the frame is 6 x 6 uint16; it must be 4 x 6 uint16");
  frame_ = fitting;
  frame_.type = SenselType::u8;
  expect_refused("the frame is 4 x 6 uint8");
  frame_ = fitting;
  frame_.data = nullptr;
  expect_refused("no data");
  frame_ = fitting;
  frame_.row_stride = 5;
  expect_refused("row_stride is 5");
  frame_ = fitting;
  plan_.segment_point = 2;
  expect_refused("segment_point is 2");
}

TEST_F(HostSolve, ABaselineStartsFromZeroWithoutATare) {
  plan_.baseline_rate = 0.25;
  plan_.skin.threshold_counts = 60;  // nothing is usable, so every sensel is untouched
  Processor processor(open_device("host"), plan_);
  processor.submit(frame_);
  static_cast<void>(processor.receive());
  EXPECT_EQ(processor.tare(), std::vector<float>(24, 12.5F));
}

}  // namespace
}  // namespace pillarfield
