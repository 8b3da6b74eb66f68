#include "contacts/estimator/pressure_regression.h"

#include <gtest/gtest.h>

#include <cmath>

namespace pillarfield {
namespace {

using Sample = PressureRegression::Sample;

/// Hertz's squared pressure, 1 in the middle and 0 on an ellipse.
double hertz(double x, double y) { return 1 - x * x / 0.81 - y * y / 0.36; }

std::vector<Sample> samples_within(double radius) {
  std::vector<Sample> samples;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      const double x = 0.1 * i;
      const double y = 0.1 * j;
      if (std::hypot(x, y) < radius) samples.push_back({x, y, hertz(x, y), 1});
    }
  }
  return samples;
}

TEST(PressureRegression, ContinuesHertzsPressure) {
  const auto fit = PressureRegression::fit(samples_within(0.45));
  ASSERT_TRUE(fit);
  for (const auto& [x, y] : {std::pair{0.7, 0.1}, {-0.3, 0.5}, {0.0, 0.0}, {0.9, 0.6}}) {
    EXPECT_NEAR(fit->at(x, y).square, hertz(x, y), 1e-9);
  }
}

TEST(PressureRegression, IsLessCertainFartherOut) {
  std::vector<Sample> samples = samples_within(0.45);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].square += i % 2 == 0 ? 0.01 : -0.01;
  const auto fit = PressureRegression::fit(samples);
  ASSERT_TRUE(fit);
  EXPECT_GT(fit->at(0.9, 0).variance, 2 * fit->at(0, 0).variance);
  EXPECT_NEAR(std::sqrt(fit->at(0, 0).variance), 0.01, 0.003);
}

TEST(PressureRegression, OutliersCountLittle) {
  std::vector<Sample> samples = samples_within(0.45);
  samples[3].square += 5;
  const auto fit = PressureRegression::fit(samples);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->at(0, 0).square, 1, 0.05);
}

TEST(PressureRegression, NeedsSamplesThatSpanThePlane) {
  EXPECT_FALSE(PressureRegression::fit({}));
  std::vector<Sample> line;
  line.reserve(40);
  for (int i = 0; i < 40; ++i) line.push_back({0.02 * i, 0.3, 1, 1});
  EXPECT_FALSE(PressureRegression::fit(line));
  const std::vector<Sample> point(40, {0.1, 0.2, 1, 1});
  EXPECT_FALSE(PressureRegression::fit(point));
  std::vector<Sample> nothing = samples_within(0.45);
  for (Sample& each : nothing) each.weight = 0;
  EXPECT_FALSE(PressureRegression::fit(nothing));
  std::vector<Sample> broken = samples_within(0.45);
  broken[0].square = std::nan("");
  const auto fit = PressureRegression::fit(broken);
  if (fit) {
    EXPECT_FALSE(fit->at(0, 0).square > 0);
  }
}

}  // namespace
}  // namespace pillarfield
