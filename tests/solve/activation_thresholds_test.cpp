// Readings below a sensel's activation threshold do not change a result; those from it on do.

#include "solve/activation_thresholds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "pillarfield/host_solve.h"

namespace pillarfield {
namespace {

SolverPlan plan_of(SenselType type, std::uint32_t seed) {
  SolverPlan plan;
  plan.skin.rows = 16;
  plan.skin.cols = 64;
  plan.sensel_type = type;
  plan.skin.threshold_counts = 2.5;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> share(0, 1);
  for (std::size_t i = 0; i < plan.skin.sensels(); ++i) {
    plan.calibration.tare.push_back(20 * share(random) - 5);
    plan.calibration.gain.push_back(0.05F + 3 * share(random));
    plan.calibration.mask.push_back(share(random) < 0.1F    ? kMissing
                                    : share(random) < 0.05F ? kAbsent
                                                            : kGood);
  }
  return plan;
}

template <class Reading>
FrameBuffer frame_of(const SolverPlan& plan, const std::vector<float>& readings) {
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  std::ranges::transform(readings, frame.readings<Reading>().begin(),
                         [](float reading) { return static_cast<Reading>(reading); });
  return frame;
}

/// Pillars whose sensels all have a threshold above zero: others are always active.
std::vector<std::uint8_t> can_be_idle(const SolverPlan& plan, const std::vector<float>& levels) {
  std::vector<std::uint8_t> can(plan.skin.pillars(), 1);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::size_t row = i / plan.skin.cols / 2;
    const std::size_t col = i % plan.skin.cols / 2;
    if (levels[i] < 1) can[row * plan.skin.pillar_cols() + col] = 0;
  }
  return can;
}

template <class Reading>
void expect_lower_readings_do_not_matter(const SolverPlan& plan, int largest) {
  const std::vector<float> levels = activation_thresholds(plan);
  const std::vector<std::uint8_t> can = can_be_idle(plan, levels);
  const std::vector<float> zero(levels.size());
  const ForceField idle = solve_on_host(plan, frame_of<Reading>(plan, zero).view());
  for (int reading = 0; reading <= largest; ++reading) {
    std::vector<float> readings(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      readings[i] = std::max(0.0F, std::min(static_cast<float>(reading), levels[i] - 1));
    }
    const ForceField field = solve_on_host(plan, frame_of<Reading>(plan, readings).view());
    for (std::size_t i = 0; i < field.elements(); ++i) {
      if (can[i] == 0) continue;
      ASSERT_EQ(field.status[i], idle.status[i]) << "pillar " << i << ", reading " << reading;
      ASSERT_EQ(field.normal[i], idle.normal[i]);
      ASSERT_EQ(field.shear_x[i], idle.shear_x[i]);
    }
  }
}

TEST(ActivationThresholds, LowerReadingsDoNotMatter) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SolverPlan plan = plan_of(SenselType::u8, seed);
    expect_lower_readings_do_not_matter<std::uint8_t>(plan, 255);
    plan.skin.full_scale_counts = 6;
    expect_lower_readings_do_not_matter<std::uint8_t>(plan, 255);
    plan.skin.full_scale_counts = 250;
    plan.skin.power_law = PowerLaw{0.7, 30};
    expect_lower_readings_do_not_matter<std::uint8_t>(plan, 255);
    expect_lower_readings_do_not_matter<std::uint16_t>(plan_of(SenselType::u16, seed), 300);
  }
}

TEST(ActivationThresholds, FractionsBelowThemDoNotMatter) {
  const SolverPlan plan = plan_of(SenselType::f32, 4);
  const std::vector<float> levels = activation_thresholds(plan);
  std::vector<float> readings = levels;
  for (float& reading : readings) reading = std::nextafter(reading, -1e30F);
  const ForceField field = solve_on_host(plan, frame_of<float>(plan, readings).view());
  const ForceField idle =
      solve_on_host(plan, frame_of<float>(plan, std::vector<float>(levels.size(), -1000)).view());
  EXPECT_EQ(field.status, idle.status);
}

TEST(ActivationThresholds, OfWholeReadingsAreTheHighest) {
  SolverPlan plan = plan_of(SenselType::u8, 5);
  plan.calibration.mask.clear();
  const std::vector<float> levels = activation_thresholds(plan);
  const ForceField field = solve_on_host(plan, frame_of<std::uint8_t>(plan, levels).view());
  const std::vector<std::uint8_t> can = can_be_idle(plan, levels);
  for (std::size_t i = 0; i < field.elements(); ++i) {
    if (can[i] == 0) continue;
    EXPECT_EQ(field.status[i] & 15, 15) << "pillar " << i;
  }
}

TEST(ActivationThresholds, OfMaskedSenselsAreNeverReached) {
  const SolverPlan plan = plan_of(SenselType::u8, 6);
  const std::vector<float> levels = activation_thresholds(plan);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    if (plan.calibration.mask[i] == kGood) continue;
    EXPECT_EQ(levels[i], 255);
  }
}

TEST(ActivationThresholds, AreOneWhereSenselsAreAlike) {
  SolverPlan plan;
  plan.skin.rows = 4;
  plan.skin.cols = 4;
  plan.skin.threshold_counts = 2.5;
  EXPECT_EQ(activation_thresholds(plan), std::vector<float>{3});
  plan.skin.threshold_counts = 2;
  EXPECT_EQ(activation_thresholds(plan), std::vector<float>{3});
  plan.skin.full_scale_counts = 2;
  EXPECT_EQ(activation_thresholds(plan), std::vector<float>{2});
  plan.baseline_rate = 0.1;
  EXPECT_EQ(activation_thresholds(plan).size(), plan.skin.sensels()) << "the tare will differ";
}

}  // namespace
}  // namespace pillarfield
