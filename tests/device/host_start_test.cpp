// Frames that arrive while kernels are compiled.

#include "device/host_start.h"

#include <gtest/gtest.h>

#include <deque>
#include <optional>
#include <random>
#include <thread>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "random_plan.h"
#include "tests/device/same_bits.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

/// A plan whose kernels no cache holds.
SolverPlan unseen_plan() {
  SolverPlan plan = full_plan(34, 46, SenselType::u16, 3);
  plan.skin.counts_per_newton = 200 + 1e-4 * (std::random_device()() % 1'000'000);
  return plan;
}

Processor starting(const SolverPlan& plan, int slots) {
  return {open_device("opencl"), plan, {.frames_in_flight = slots, .start_on_host = true}};
}

void expect_solved(const ForceFieldView& forces, const SolverPlan& plan, const RandomFrame& frame) {
  expect_same_bits(forces, solve_on_host(plan, frame.view()).view());
}

TEST(HostStart, FramesHaveTheSameBitsBeforeAndAfterTheKernelsAreCompiled) {
  const SolverPlan plan = unseen_plan();
  Processor processor = starting(plan, 3);
  ASSERT_TRUE(processor.is_compiling());
  std::deque<RandomFrame> frames;
  std::uint32_t submitted = 0;
  for (int on_device = 0; on_device < 7; on_device += processor.is_compiling() ? 0 : 1) {
    while (processor.in_flight() < 3) {
      frames.emplace_back(plan, 0, submitted++);
      processor.submit(frames.back().view());
    }
    if (on_device % 2 == 0) {
      expect_solved(processor.receive(), plan, frames.front());
    } else {
      std::optional<ForceFieldView> forces;
      while (!(forces = processor.try_receive())) continue;
      expect_solved(*forces, plan, frames.front());
    }
    frames.pop_front();
  }
  EXPECT_GT(submitted, 10);
}

TEST(HostStart, ResultsStayValidWhileTheirSlotIsNotUsed) {
  const SolverPlan plan = unseen_plan();
  Processor processor = starting(plan, 3);
  const RandomFrame frame(plan, 0, 1);
  const RandomFrame other(plan, 0, 2);
  processor.submit(frame.view());
  const ForceFieldView first = processor.receive();
  while (processor.is_compiling()) std::this_thread::yield();
  for (int i = 0; i < 2; ++i) {
    processor.submit(other.view());
    expect_solved(processor.receive(), plan, other);
  }
  expect_solved(first, plan, frame);
}

TEST(HostStart, RefusesWhatAnyProcessorRefuses) {
  const SolverPlan plan = unseen_plan();
  Processor processor = starting(plan, 2);
  const RandomFrame frame(plan, 0, 1);
  EXPECT_THROW((void)processor.receive(), Error);
  EXPECT_THROW((void)processor.pin(), Error);
  EXPECT_THROW(processor.submit(RandomFrame(bare_plan(4, 4, SenselType::u8), 0, 1).view()), Error);
  EXPECT_EQ(processor.in_flight(), 0);
  processor.submit(frame.view());
  processor.submit(frame.view());
  EXPECT_THROW(processor.submit(frame.view()), Error);
  EXPECT_THROW((void)processor.pin(), Error);
  while (processor.is_compiling()) std::this_thread::yield();
  EXPECT_THROW(processor.submit(frame.view()), Error);
  EXPECT_EQ(processor.in_flight(), 2);
  for (int i = 0; i < 2; ++i) expect_solved(processor.receive(), plan, frame);
  EXPECT_THROW((void)processor.receive(), Error);
}

TEST(HostStart, ANewTareServesTheFramesAfterIt) {
  SolverPlan plan = unseen_plan();
  Processor processor = starting(plan, 2);
  EXPECT_EQ(processor.tare(), plan.calibration.tare);
  const RandomFrame frame(plan, 0, 1);
  processor.submit(frame.view());
  SolverPlan retared = plan;
  for (float& tare : retared.calibration.tare) tare += 2.5F;
  processor.set_plan(retared);
  EXPECT_FALSE(processor.is_compiling());
  processor.submit(frame.view());
  expect_solved(processor.receive(), plan, frame);
  expect_solved(processor.receive(), retared, frame);
}

TEST(HostStart, AProcessorMayEndOrMoveWhileItCompiles) {
  const SolverPlan plan = unseen_plan();
  const RandomFrame frame(plan, 0, 1);
  Processor processor = starting(plan, 1);
  Processor moved = std::move(processor);
  moved.submit(frame.view());
  expect_solved(moved.receive(), plan, frame);
}

}  // namespace
}  // namespace pillarfield
