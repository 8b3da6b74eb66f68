// The host's lanes, in a program that finds no OpenCL driver.

#include <gtest/gtest.h>

#include <string>

#include "lanes/lane_plan.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "tests/device/same_bits.h"

namespace pillarfield {
namespace {

TEST(Lanes, AreTheDeviceOfSkinsWithoutOpenCl) {
  EXPECT_TRUE(list_devices().empty());
  EXPECT_EQ(open_device().info().type, "host");
  for (const std::uint32_t side : {4U, 600U}) {
    const SolverPlan plan = bare_plan(side, side, SenselType::u8);
    EXPECT_EQ(open_device().for_plan(plan).info().name, open_device("host").info().name);
  }
  EXPECT_THROW((void)open_device("opencl"), Error);
  EXPECT_THROW((void)open_device("0"), Error);
}

TEST(Lanes, NameTheirInstructions) {
  const std::string widest = lane_programs().front()->name;
  EXPECT_EQ(open_device("host").info().name, "host, " + widest);
  EXPECT_EQ(lane_programs().back()->lanes, 2);
}

/// Frames that threads share; solve_on_host() solves them in one thread by the first program.
TEST(Lanes, LargeFramesHaveTheSameBitsInEveryProgram) {
  for (const LaneProgram* program : lane_programs()) {
    SCOPED_TRACE(program->name);
    for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
      for (const SolverPlan& plan : {bare_plan(210, 250, type), full_plan(210, 250, type, 3)}) {
        const RandomFrame frame(plan, 0, 1);
        Processor processor(open_device("host"), plan, {}, {.lanes = program->lanes});
        processor.submit(frame.view());
        expect_same_bits(processor.receive(), solve_on_host(plan, frame.view()).view());
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield
