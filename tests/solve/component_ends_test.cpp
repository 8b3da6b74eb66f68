// Intervals of the components of a force.

#include "pillarfield/component_ends.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <set>
#include <string>

#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr auto kEnds = [](std::size_t component) {
  return std::pair{2 * component, 2 * component + 1};
};

/// Solves a pillar from the readings of its sensels 1 to 4.
ForceField solved(const std::array<float, 4>& readings, SolverPlan& plan) {
  plan.skin.rows = 2;
  plan.skin.cols = 2;
  plan.skin.counts_per_newton = 100;
  plan.skin.threshold_counts = 2;
  plan.sensel_type = SenselType::f32;
  plan.estimator = Estimator::direct;
  plan.noise_counts = 0.5;
  plan.uncertainty = true;
  FrameBuffer raw(SenselType::f32, 2, 2);
  const std::array<float, 4> rows = {readings[1], readings[0], readings[2], readings[3]};
  std::memcpy(raw.bytes().data(), rows.data(), sizeof rows);
  return solve_on_host(plan, raw.view());
}

void expect_about(const std::array<float, kComponentEnds>& ends, std::size_t component,
                  double value, double deviation) {
  const auto [low, high] = kEnds(component);
  EXPECT_NEAR(ends[low], value - 1.96 * deviation, 1e-6);
  EXPECT_NEAR(ends[high], value + 1.96 * deviation, 1e-6);
}

TEST(ComponentEnds, OfADeterminedForceAreItsDeviations) {
  SolverPlan plan;
  const ForceField field = solved({50, 40, 30, 40}, plan);
  for (const auto& point : {std::optional<double>(), std::optional(plan.segment_point)}) {
    const auto ends = component_ends(field.view(), 0, point);
    expect_about(ends, 0, field.shear_x[0], field.uncertainty[Uncertainty::shear_x][0]);
    expect_about(ends, 1, field.shear_y[0], field.uncertainty[Uncertainty::shear_y][0]);
    expect_about(ends, 2, field.normal[0], field.uncertainty[Uncertainty::normal][0]);
  }
}

/// Region 3, with the upper, left, lower or right two sensels usable: parity sums from zero to the
/// smaller reading plus the threshold are consistent with the readings.
TEST(ComponentEnds, OfADirectForceHoldItsSegment) {
  for (const std::array<float, 4>& readings :
       {std::array<float, 4>{60, 45, 0, 0}, {0, 60, 45, 0}, {0, 0, 45, 60}, {45, 0, 0, 60}}) {
    for (const double point : {0.5, 0.875, 1.0}) {
      SolverPlan plan;
      plan.segment_point = point;
      const ForceField field = solved(readings, plan);
      ASSERT_EQ(region_of(field.status[0]), Region::three);
      const auto ends = component_ends(field.view(), 0, point);
      const bool vertical = readings[0] * readings[1] > 0 || readings[2] * readings[3] > 0;
      const double high = field.normal[0] / point;
      const double noise_n = 0.5 / 100;
      EXPECT_EQ(ends[4], 0);
      EXPECT_GT(ends[5], high);
      EXPECT_LT(ends[5], high + 1.96 * noise_n);
      const double moving = vertical ? field.shear_y[0] : field.shear_x[0];
      const double sign = std::copysign(1.0, moving);
      const double most = sign * (std::abs(moving) + std::numbers::sqrt2 * field.normal[0]);
      const double least =
          sign * (std::abs(moving) - std::numbers::sqrt2 * (high - field.normal[0]));
      const auto [low_end, high_end] = kEnds(vertical ? 1 : 0);
      EXPECT_LT(ends[low_end], std::min(least, most));
      EXPECT_GT(ends[high_end], std::max(least, most));
      EXPECT_GT(ends[low_end], std::min(least, most) - 4 * noise_n);
      EXPECT_LT(ends[high_end], std::max(least, most) + 4 * noise_n);
      // The other component is measured.
      const std::size_t fixed = vertical ? 0 : 1;
      const auto kind = vertical ? Uncertainty::shear_x : Uncertainty::shear_y;
      expect_about(ends, fixed, vertical ? field.shear_x[0] : field.shear_y[0],
                   field.uncertainty[kind][0]);
    }
  }
}

/// A shear coefficient scales the ends of its component, and off-centre pressure shifts them, even
/// where it turns the sign of the shear.
TEST(ComponentEnds, FollowTheCoefficientAndOffCentrePressure) {
  for (const std::array<float, 4>& readings :
       {std::array<float, 4>{60, 45, 0, 0}, {0, 60, 45, 0}, {0, 0, 45, 60}, {45, 0, 0, 60}}) {
    SolverPlan ideal;
    const ForceField first = solved(readings, ideal);
    const auto before = component_ends(first.view(), 0, ideal.segment_point);
    SolverPlan plan;
    plan.calibration.effects.shear_coefficient = {0.8, 1.25};
    ForceField field = solved(readings, plan);
    for (const float lean : {0.0F, 2.0F, -2.0F}) {
      ForceField shifted = field;
      shifted.shear_x[0] += lean;
      shifted.shear_y[0] += lean;
      const auto ends = component_ends(shifted.view(), 0, plan.segment_point, {0.8, 1.25});
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(ends[i], before[i] / 0.8 + lean, 1e-5);
        EXPECT_NEAR(ends[2 + i], before[2 + i] / 1.25 + lean, 1e-5);
        EXPECT_NEAR(ends[4 + i], before[4 + i], 1e-6);
      }
    }
  }
}

/// Two adjacent sensels at full scale: what the other two determine is finite, the rest is open.
TEST(ComponentEnds, OfASaturatedPillarAreOpen) {
  SolverPlan plan;
  plan.skin.full_scale_counts = 255;
  const ForceField field = solved({255, 255, 90, 80}, plan);
  ASSERT_NE(field.status[0] & status::kSaturated, 0);
  for (const auto& point : {std::optional<double>(), std::optional(plan.segment_point)}) {
    const auto ends = component_ends(field.view(), 0, point);
    expect_about(ends, 0, field.shear_x[0], field.uncertainty[Uncertainty::shear_x][0]);
    EXPECT_LT(ends[1] - ends[0], 0.1);
    EXPECT_FLOAT_EQ(ends[2], -1.96F * kOpenN);
    EXPECT_FLOAT_EQ(ends[3], 1.96F * kOpenN);
    EXPECT_EQ(ends[4], 0);
    EXPECT_FLOAT_EQ(ends[5], 1.96F * kOpenN);
  }
}

TEST(ComponentEnds, OfAnotherEstimatorAreDeviationsButNoPull) {
  SolverPlan plan;
  ForceField field = solved({60, 45, 0, 0}, plan);
  field.uncertainty[Uncertainty::normal][0] = 2 * field.normal[0];
  const auto ends = component_ends(field.view(), 0, std::nullopt);
  EXPECT_EQ(ends[4], 0);
  EXPECT_NEAR(ends[5], field.normal[0] * (1 + 2 * 1.96), 1e-5);
  expect_about(ends, 1, field.shear_y[0], field.uncertainty[Uncertainty::shear_y][0]);
}

TEST(ComponentEnds, HaveNames) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < kComponentEnds; ++i) {
    names.insert(name_of(static_cast<ComponentEnd>(i)));
  }
  EXPECT_EQ(names, (std::set<std::string>{"normal_high", "normal_low", "shear_x_high",
                                          "shear_x_low", "shear_y_high", "shear_y_low"}));
}

}  // namespace
}  // namespace pillarfield
