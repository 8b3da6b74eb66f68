#include "lab/studies/small_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pillarfield::small_forces_study {
namespace {

using std::numbers::pi;

const std::vector<SmallForcePoint>& points() {
  static const std::vector<SmallForcePoint> result = small_forces();
  return result;
}

/// Fractions of the hemisphere by equation (2) on a grid of equal areas.
struct Fractions {
  double undetected = 0;
  double wrong_region = 0;
};

Fractions expected_fractions(double load) {
  constexpr int kGrid = 200;
  const double hidden_fraction =
      (kStudyDeadZoneCounts + kStudyThresholdCounts + 0.5) / kStudyDeadZoneCounts / load;
  Fractions fractions;
  for (int i = 0; i < kGrid; ++i) {
    const double theta = std::acos((i + 0.5) / kGrid);
    for (int j = 0; j < kGrid; ++j) {
      const double phi = 2 * pi * (j + 0.5) / kGrid;
      int pressed = 0;
      int usable = 0;
      for (int n = 1; n <= 4; ++n) {
        const double v = std::cos(theta) - std::sin(theta) * std::cos(pi / 4 * (2 * n - 1) - phi);
        pressed += v > 0 ? 1 : 0;
        usable += v > hidden_fraction ? 1 : 0;
      }
      fractions.undetected += usable == 0 ? 1 : 0;
      fractions.wrong_region += usable != 0 && usable != pressed ? 1 : 0;
    }
  }
  return {fractions.undetected / (kGrid * kGrid), fractions.wrong_region / (kGrid * kGrid)};
}

TEST(SmallForces, FractionsMatchTheModel) {
  for (const SmallForcePoint& point : points()) {
    const Fractions expected = expected_fractions(point.load);
    for (const SmallForceErrors* errors : {&point.paper, &point.naive, &point.direct}) {
      EXPECT_NEAR(errors->undetected, expected.undetected, 0.02) << point.load;
      EXPECT_NEAR(errors->wrong_region, expected.wrong_region, 0.02) << point.load;
    }
  }
}

TEST(SmallForces, CalibrationFlagsEveryWrongRegion) {
  bool unflagged_before = false;
  for (const SmallForcePoint& point : points()) {
    EXPECT_EQ(point.direct.unflagged, 0) << point.load;
    unflagged_before |= point.naive.unflagged > 0.05;
  }
  EXPECT_TRUE(unflagged_before);
}

TEST(SmallForces, CalibratedIntervalsHoldTheTruth) {
  for (const SmallForcePoint& point : points()) {
    EXPECT_GE(point.direct.held, 0.995) << point.load;
    EXPECT_LE(point.naive.held, 0.5) << point.load;
  }
}

// With three or four usable sensels a dead zone takes z counts from each: the shear is exact, the
// normal force z / k short. Calibration leaves noise of at most sqrt(5/2) deviations over k.
TEST(SmallForces, CalibrationLeavesOnlyNoiseInDeterminedForces) {
  const double noise = std::hypot(kStudyNoiseCounts, 1 / std::sqrt(12.0)) / kStudyDeadZoneCounts;
  for (const SmallForcePoint& point : points()) {
    if (std::isnan(point.direct.determined)) continue;
    EXPECT_NEAR(point.naive.determined * point.load, 1, 0.02) << point.load;
    EXPECT_NEAR(point.paper.determined * point.load, 1, 0.02) << point.load;
    const double deviations = point.direct.determined * point.load / noise;
    EXPECT_GT(deviations, std::sqrt(5.0) / 2) << point.load;
    EXPECT_LT(deviations, std::sqrt(5.0 / 2)) << point.load;
  }
}

}  // namespace
}  // namespace pillarfield::small_forces_study
