// The solve in 16-bit integers gives the bits of the host's single precision for all readings and
// limits.

#include <gtest/gtest.h>

#include <array>

#include "pillarfield/host_solve.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"
#include "same_bits.h"
#include "test_device.h"

namespace pillarfield {
namespace {

/// Readings around the limits of the plans below.
constexpr std::array<std::uint8_t, 13> kReadings = {0,  1,   2,   3,   4,   7,  20,
                                                    21, 127, 250, 251, 254, 255};

/// All combinations of four of these readings, one per pillar; the order mixes them within a block.
FrameBuffer all_pillars() {
  constexpr std::size_t kSide = kReadings.size() * kReadings.size();
  FrameBuffer frame(SenselType::u8, 2 * kSide, 2 * kSide);
  const auto bytes = frame.bytes();
  const auto reading = [](std::size_t i) { return std::byte{kReadings[i % kReadings.size()]}; };
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t col = 0; col < kSide; ++col) {
      const std::size_t first = 4 * row * kSide + 2 * col;
      bytes[first] = reading(row);
      bytes[first + 1] = reading(row / kReadings.size());
      bytes[first + 2 * kSide] = reading(col);
      bytes[first + 2 * kSide + 1] = reading(col / kReadings.size());
    }
  }
  return frame;
}

class WholeNumbers : public testing::Test {
 protected:
  static SolverPlan plan_of(double threshold_counts) {
    SolverPlan plan = bare_plan(kFrame.view().rows, kFrame.view().cols, SenselType::u8);
    plan.skin.threshold_counts = threshold_counts;
    plan.skin.counts_per_newton = 317;
    return plan;
  }

  static void expect_host_bits(const SolverPlan& plan, int lanes = 0) {
    Processor processor(test_device(), plan, {}, {.lanes = tested_lanes(lanes)});
    processor.submit(kFrame.view());
    expect_same_bits(processor.receive(), solve_on_host(plan, kFrame.view()).view());
  }

 private:
  static inline const FrameBuffer kFrame = all_pillars();
};

TEST_F(WholeNumbers, EveryThreshold) {
  std::size_t next = 0;
  for (const double threshold :
       {0.0, 0.5, 2.0, 2.3, 2.5, 126.5, 254.0, 255.0, 300.0, 500.0, 500.5, 1000.0}) {
    SolverPlan plan = plan_of(threshold);
    plan.segment_point = std::array{0.875, 0.75, 0.5}[next++ % 3];
    SCOPED_TRACE(testing::Message() << plan.segment_point << " behind " << threshold);
    expect_host_bits(plan);
  }
}

/// Points that whole numbers do not represent exactly; the others are above.
TEST_F(WholeNumbers, EveryOtherSegmentPoint) {
  for (const double point : {1e-3, 0.7, 0.9375, 1.0}) {
    SCOPED_TRACE(point);
    SolverPlan plan = plan_of(2);
    plan.segment_point = point;
    expect_host_bits(plan);
  }
}

/// Limits of readings, parity, noise and segment, several at a time.
TEST_F(WholeNumbers, LimitsTogether) {
  struct Limits {
    double full_scale, parity_tolerance, noise, segment_point;
  };
  for (const Limits& limits : {Limits{2.5, 5000, 0.1, 0.5},
                               {3, 250.1, 0, 0.75},
                               {20.5, 0, 0.4, 0.875},
                               {250.1, 3.9, 0.636, 0.5},
                               {250.5, 1, 3, 0.75},
                               {255, 3.7, 20, 0.875},
                               {4000, 0.25, 1e6, 0.5}}) {
    SCOPED_TRACE(limits.full_scale);
    SolverPlan plan = plan_of(2);
    plan.skin.full_scale_counts = limits.full_scale;
    plan.parity_tolerance_counts = limits.parity_tolerance;
    plan.noise_counts = limits.noise;
    plan.segment_point = limits.segment_point;
    expect_host_bits(plan);
  }
}

TEST_F(WholeNumbers, EveryLaneWidth) {
  SolverPlan plan = plan_of(2.5);
  plan.skin.full_scale_counts = 250.5;
  plan.parity_tolerance_counts = 3.7;
  plan.noise_counts = 0.4;
  for (const int lanes : {1, 2, 4, 8, 16}) {
    SCOPED_TRACE(lanes);
    expect_host_bits(plan, lanes);
  }
}

}  // namespace
}  // namespace pillarfield
