// A processor frees its memory. LeakSanitizer does not work with PoCL's threads, so the test
// measures the heap: a leaked plane, frame or kernel would exceed the limit by far.

#include <gtest/gtest.h>
#include <malloc.h>

#include "pillarfield/processor.h"
#include "tests/device/random_plan.h"
#include "tests/device/test_device.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kSensels = 128;  // on a side: a plane of results takes 16 KiB

/// Allocated bytes of the heap, including large blocks.
std::size_t heap_bytes() {
  const struct mallinfo2 heap = mallinfo2();
  return heap.uordblks + heap.hblkhd;
}

/// Opens, uses and closes `count` processors.
void use_processors(const SolverPlan& plan, const Processor::Options& options, int count) {
  const RandomFrame frame(plan, 0, 1);
  for (int i = 0; i < count; ++i) {
    Processor processor(test_device(), plan, options);
    processor.submit(frame.view());
    (void)processor.receive();
  }
}

void expect_no_growth(const SolverPlan& plan, const Processor::Options& options) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "AddressSanitizer has a heap of its own";
#endif
  if (options.memory == Memory::shared && !test_device().info().shares_memory) {
    GTEST_SKIP() << "the device has memory of its own";
  }
  constexpr int kProcessors = 60;
  constexpr std::size_t kMostBytesEach = 4096;  // PoCL itself leaves some hundred bytes
  use_processors(plan, options, 10);
  const std::size_t before = heap_bytes();
  use_processors(plan, options, kProcessors);
  EXPECT_LT(heap_bytes(), before + kProcessors * kMostBytesEach);
}

TEST(ProcessorLeak, BareSolveLeavesNothing) {
  for (const Memory memory : {Memory::staged, Memory::shared}) {
    expect_no_growth(bare_plan(kSensels, kSensels, SenselType::u8), {.memory = memory});
  }
}

TEST(ProcessorLeak, AllStagesLeaveNothing) {
  SolverPlan plan = full_plan(kSensels, kSensels, SenselType::u16, 1);
  plan.angles = true;
  plan.uncertainty = true;
  expect_no_growth(plan, {.memory = Memory::shared});
}

TEST(ProcessorLeak, ContactEstimatorLeavesNothing) {
  SolverPlan plan = bare_plan(kSensels, kSensels, SenselType::u8);
  plan.estimator = Estimator::contact;
  expect_no_growth(plan, {.memory = Memory::shared});
}

}  // namespace
}  // namespace pillarfield
