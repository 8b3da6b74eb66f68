// Solve variants, their frames, and the loop in double precision.

#include "bench/variants.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "bench/baselines/double_loop.h"
#include "bench/noisy_frames.h"
#include "bench/solve_variant.h"
#include "pillarfield/error.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield::bench {
namespace {

constexpr std::uint32_t kSide = 48;

TEST(SolveVariants, HaveNamesOfTheirOwnAndPlansThatHold) {
  std::set<std::string> names;
  for (const SolveVariant& variant : solve_variants()) {
    names.insert(name_of(variant));
    EXPECT_NO_THROW(check(plan_of(variant, kSide), name_of(variant)));
  }
  EXPECT_EQ(names.size(), solve_variants().size());
  EXPECT_TRUE(names.contains("direct/float/u8/none"));
  EXPECT_TRUE(names.contains("direct/double/f32/all"));
  EXPECT_FALSE(names.contains("paper/float/u8/uncertainty"));
}

/// Standard deviation of the readings of unloaded sensels, counts of a uint8 sensel.
double idle_noise(const SolverPlan& plan) {
  const NoisyFrames frames(plan, 1);
  const auto* const readings = static_cast<const float*>(frames.frames()[0].data);
  double squares = 0;
  int count = 0;
  for (std::uint32_t row = 0; row < kSide; ++row) {
    for (std::uint32_t col = 0; col < kSide; ++col) {
      const auto v =
          double_precision::model_readings(frames.truth(0, row, col), plan.skin.counts_per_newton);
      if (v.v2 > 0) continue;
      const double reading = readings[std::size_t{4} * row * kSide + std::size_t{2} * col];
      squares += reading * reading;
      ++count;
    }
  }
  return std::sqrt(squares / count);
}

TEST(NoisyFrames, HaveTheNoiseTheySay) {
  EXPECT_NEAR(idle_noise(plan_of({.type = SenselType::f32}, kSide)), kSensorNoiseCounts, 0.04);
}

TEST(NoisyFrames, AreSolvedToTheForcesTheySay) {
  for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    const SolverPlan plan = plan_of({.type = type, .stage = "calibration"}, kSide);
    const NoisyFrames frames(plan, 2);
    const ForceField solved = solve_on_host(plan, frames.frames()[1]);
    const double newtons_per_count = count_scale(type) / plan.skin.counts_per_newton;
    int in_region_one = 0;
    for (std::uint32_t row = 0; row < kSide; ++row) {
      for (std::uint32_t col = 0; col < kSide; ++col) {
        const std::size_t pillar = row * kSide + col;
        if (solved.status[pillar] != status::kUsable) continue;
        ++in_region_one;
        const auto truth = frames.truth(1, row, col);
        const double most = 5 * newtons_per_count;
        EXPECT_NEAR(solved.shear_x[pillar], truth.shear_x, most);
        EXPECT_NEAR(solved.shear_y[pillar], truth.shear_y, most);
        EXPECT_NEAR(solved.normal[pillar], truth.normal, most);
      }
    }
    EXPECT_GT(in_region_one, static_cast<int>(kSide * kSide / 6));
  }
}

TEST(NoisyFrames, AreTheSameEachTimeAndDifferFromFrameToFrame) {
  const SolverPlan plan = plan_of({}, kSide);
  const NoisyFrames one(plan, 2);
  const NoisyFrames other(plan, 1);
  EXPECT_EQ(std::memcmp(one.frames()[0].data, other.frames()[0].data, plan.skin.sensels()), 0);
  EXPECT_NE(std::memcmp(one.frames()[0].data, one.frames()[1].data, plan.skin.sensels()), 0);
}

/// Fraction of pillars whose status differs, or whose force differs by more than 1e-4 of it.
double different_fraction(const ForceFieldView& a, const ForceFieldView& b) {
  std::size_t others = 0;
  for (std::size_t i = 0; i < a.status.size(); ++i) {
    const double size = std::hypot(a.shear_x[i], a.shear_y[i], a.normal[i]);
    const double distance = std::hypot(a.shear_x[i] - b.shear_x[i], a.shear_y[i] - b.shear_y[i],
                                       a.normal[i] - b.normal[i]);
    others += a.status[i] != b.status[i] || !(distance <= 1e-4 * size) ? 1U : 0U;
  }
  return static_cast<double>(others) / static_cast<double>(a.status.size());
}

TEST(DoubleLoop, SolvesEveryVariantAsSinglePrecisionDoesButForRounding) {
  for (const SolveVariant& variant : solve_variants()) {
    if (variant.arithmetic != Arithmetic::host_double) continue;
    const SolverPlan plan = plan_of(variant, kSide);
    const NoisyFrames frames(plan, 1);
    DoubleLoop loop(plan, 2);
    const ForceField single = solve_on_host(plan, frames.frames()[0]);
    // Rounding rarely moves a reading across the threshold.
    EXPECT_LE(different_fraction(loop.solve(frames.frames()[0]), single.view()), 1e-3)
        << name_of(variant);
  }
}

TEST(DoubleLoop, RefusesAStageThatNoVariantHas) {
  SolverPlan plan = plan_of({}, kSide);
  plan.parity_tolerance_counts = 3;
  EXPECT_THROW(DoubleLoop(plan, 1), Error);
  SolverPlan only_tare = plan_of({}, kSide);
  add_stage(only_tare, "tare");
  EXPECT_THROW(DoubleLoop(only_tare, 1), Error);
}

}  // namespace
}  // namespace pillarfield::bench
