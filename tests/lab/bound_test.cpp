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
