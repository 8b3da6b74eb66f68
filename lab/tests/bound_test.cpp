// The Cramér–Rao bound, and that the direct solve has it wherever noise cannot carry a reading over
// the threshold.

#include "lab/studies/bound.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace pillarfield::bound {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kForceCounts = 60;

/// One newton is one count; the threshold is at five standard deviations.
PillarSensor sensor_of(double noise_counts) {
  PillarSensor sensor;
  sensor.threshold_counts = 5 * noise_counts;
  sensor.noise_counts = noise_counts;
  return sensor;
}

/// Expectation of the squared derivative of the log-likelihood, by the trapezoidal rule.
double integrated_information(double deviations) {
  constexpr double kStep = 1e-3;
  double sum = 0;
  for (int i = 0; - deviations + i * kStep < 12; ++i) {
    const double u = -deviations + i * kStep;
    const double low = u * u * std::exp(-u * u / 2);
    const double high = (u + kStep) * (u + kStep) * std::exp(-(u + kStep) * (u + kStep) / 2);
    sum += kStep * (low + high) / 2;
  }
  const double spoken = sum / std::sqrt(2 * std::numbers::pi);
  const auto log_idle = [](double d) { return std::log(std::erfc(d / std::numbers::sqrt2) / 2); };
  const double slope = (log_idle(deviations + 1e-5) - log_idle(deviations - 1e-5)) / 2e-5;
  return spoken + slope * slope * std::exp(log_idle(deviations));
}

TEST(Information, IsTheExpectedSquareOfTheScore) {
  for (int i = -8; i <= 8; ++i) {
    const double deviations = i / 2.0;
    EXPECT_NEAR(information(deviations), integrated_information(deviations), 1e-5) << deviations;
  }
}

TEST(Information, GrowsFromNothingToThatOfAReading) {
  EXPECT_NEAR(information(-8), 0, 1e-12);
  EXPECT_NEAR(information(8), 1, 1e-12);
  EXPECT_EQ(information(50), 1);
  for (int i = -32; i < 32; ++i) {
    const double deviations = i / 4.0;
    EXPECT_LT(information(deviations), information(deviations + 0.25) + 1e-14);
  }
}

TEST(LeastError, IsThatOfFourAndOfThreeReadingsWhateverTheDirection) {
  PillarSensor sensor = sensor_of(0.5);
  sensor.counts_per_newton = 320;
  const double unit = 0.5 / 320;
  int in_two = 0;
  for (int theta = 0; theta < 85; theta += 5) {
    for (int phi = -180; phi < 180; phi += 15) {
      const Force force = force_from(1, theta * kDegree, phi * kDegree);
      if (!is_far_from_borders(force, sensor, 8)) continue;
      const int usable = usable_sensels(force, sensor);
      if (usable < 3) continue;
      const double expected = std::sqrt(usable == 4 ? 1.25 : 2.5) * unit;
      EXPECT_NEAR(least_error(force, sensor), expected, 1e-9 * unit);
      in_two += usable == 3 ? 1 : 0;
    }
  }
  EXPECT_GT(in_two, 30);
}

TEST(LeastError, OfUnequalSensorsIsThatOfTheirVariances) {
  // V = (50, 30, -10, 10), of which three are usable: N = (V2 + V4) / 2, and the shear along the
  // diagonals is sqrt(2) (V1 - N) and (V2 - V4) / sqrt(2).
  Sensels sensels;
  sensels[0] = sensor_of(0.4);
  sensels[1] = sensor_of(0.5);
  sensels[2] = sensor_of(0.6);
  sensels[3] = sensor_of(0.8);
  const Force force = {10 * std::numbers::sqrt2, 20 * std::numbers::sqrt2, 20};
  const double variance = 0.4 * 0.4 + 3 * (0.5 * 0.5 + 0.8 * 0.8) / 4;
  EXPECT_EQ(usable_sensels(force, sensels), 3);
  EXPECT_NEAR(least_error(force, sensels), std::sqrt(variance), 1e-6);
}

TEST(LeastError, LosesNoMoreThanAnInactiveSenselAdds) {
  // B5: a fourth reading of weight w takes 5 w / (1 + 3 w) from the squared bound of 5/2.
  const PillarSensor sensor = sensor_of(1);
  const Force force = {10.5 * std::numbers::sqrt2, 10.5 * std::numbers::sqrt2, 22};  // V3 = 1
  const double weight = information(1 - 5);
  EXPECT_NEAR(least_error(force, sensor), std::sqrt(2.5 - 5 * weight / (1 + 3 * weight)), 1e-9);
}

TEST(Misreading, CostsItsChanceTimesTheSquareOfItsJump) {
  // V = (60, 40, -12, 8): where the last is lost, S is taken for 7/8 of 45, not 48 (B6).
  const PillarSensor sensor = sensor_of(1);
  const Force force = {10 * std::numbers::sqrt2, 26 * std::numbers::sqrt2, 24};
  const double chance = std::erfc(3 / std::numbers::sqrt2) / 2;
  const double jump = (48 - kSegmentPoint * 45) * std::sqrt(3) / 2;
  const RmsError error = rms_error(force, sensor, Estimator::direct, 400'000, 0);
  EXPECT_NEAR(error.misread_share, chance, 2e-4);
  EXPECT_NEAR(error.of_all, std::sqrt(2.5 + chance * jump * jump), 0.005);
  EXPECT_GT(error.of_all / least_error(force, sensor), 1.01);
}

class DirectSolve : public testing::TestWithParam<double> {
 protected:
  /// Calls `check(ratio, error)` for directions whose readings are `deviations` standard deviations
  /// or more from the threshold.
  template <class Check>
  static void for_directions(double deviations, Check check) {
    constexpr int kDraws = 40'000;  // a standard error of 0.3 %
    const PillarSensor sensor = sensor_of(GetParam());
    std::uint64_t number = 0;
    for (int theta = 0; theta < 90; theta += 5) {
      for (int eighth = 0; eighth <= 8; ++eighth) {
        const double phi = 11.25 * eighth;
        const Force force = force_from(kForceCounts, theta * kDegree, phi * kDegree);
        if (usable_sensels(force, sensor) < 3) continue;
        if (!is_far_from_borders(force, sensor, deviations)) continue;
        SCOPED_TRACE(fmt::format("theta {}, phi {}", theta, phi));
        check(least_error(force, sensor),
              rms_error(force, sensor, Estimator::direct, kDraws, ++number));
      }
    }
    EXPECT_GT(number, 60U);
  }
};

TEST_P(DirectSolve, IsOnTheBoundInRegionsOneAndTwo) {
  double least = 2;
  double most = 0;
  for_directions(3, [&](double bound, const RmsError& error) {
    const double ratio = error.of_rightly_read / bound;
    EXPECT_LE(ratio, 1.03);
    EXPECT_GE(ratio, 0.985);
    EXPECT_LE(error.misread_share, 0.005);
    least = std::min(least, ratio);
    most = std::max(most, ratio);
  });
  std::printf("%g counts of noise: %.4f to %.4f times the bound\n", GetParam(), least, most);
}

TEST_P(DirectSolve, IsOnTheBoundWithWhateverIsMisreadFarFromBorders) {
  for_directions(
      5, [&](double bound, const RmsError& error) { EXPECT_LE(error.of_all / bound, 1.03); });
}

INSTANTIATE_TEST_SUITE_P(WithNoiseOf, DirectSolve, testing::Values(0.5, 1.0, 2.0));

}  // namespace
}  // namespace pillarfield::bound
