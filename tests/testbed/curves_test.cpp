#include "testbed/curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <string_view>

#include "testbed/magnitude.h"

namespace pillarfield::testbed {
namespace {

/// The bracket of equation (2), written independently.
double bracket(int n, double theta, double phi) {
  return std::cos(theta) - std::sin(theta) * std::cos(kPi / 4 * (2 * n - 1) - phi);
}

TEST(Border, IsEquationThree) {
  for (int n = 1; n <= 4; ++n) {
    for (int degree = 0; degree < 360; ++degree) {
      const double phi = degree * kPi / 180;
      const double cosine = std::cos(kPi / 4 * (2 * n - 1) - phi);
      const double expected = cosine > 0 ? std::atan2(1, cosine) : kPi / 2;
      EXPECT_NEAR(border_theta(n, phi), expected, 1e-14) << n << ' ' << degree;
    }
  }
}

void expect_inactive_as_named(const RegionLabel& label, double tolerance) {
  const std::string_view name = label.name;
  for (int n = 1; n <= 4; ++n) {
    const bool inactive = name.find(static_cast<char>('0' + n), 1) != std::string_view::npos;
    EXPECT_EQ(bracket(n, label.place.theta, label.place.phi) <= tolerance, inactive)
        << name << ' ' << n;
  }
}

TEST(RegionLabels, NameTheInactiveSensels) {
  for (const RegionLabel& label : kRegionLabels) expect_inactive_as_named(label, 0);
  for (const RegionLabel& label : kCornerLabels) expect_inactive_as_named(label, 1e-9);
}

class Contour : public testing::TestWithParam<double> {};

TEST_P(Contour, HoldsTheRatioWithinItsRegion) {
  const double ratio = GetParam();
  const std::vector<Angles> points = contour(ratio, 50);
  ASSERT_EQ(points.size(), 50U);
  for (const auto& [theta, phi] : points) {
    EXPECT_NEAR(bracket(3, theta, phi), ratio * bracket(4, theta, phi), 1e-12);
    EXPECT_LE(bracket(1, theta, phi), 1e-12);
    EXPECT_LE(bracket(2, theta, phi), 1e-12);
  }
  EXPECT_NEAR(points.front().theta, kPi / 2, 1e-12);
  const auto [theta, phi] = points.back();
  EXPECT_NEAR(std::max(bracket(1, theta, phi), bracket(2, theta, phi)), 0, 1e-12);
}

TEST_P(Contour, EstimatesLieOnIt) {
  const double ratio = GetParam();
  for (const Estimator estimator : {Estimator::paper, Estimator::direct}) {
    const auto [theta, phi] = point_on_contour(ratio, estimator);
    EXPECT_NEAR(bracket(3, theta, phi), ratio * bracket(4, theta, phi), 1e-12);
  }
  const std::vector<Angles> ends = contour(ratio, 2);
  EXPECT_NEAR(point_on_contour(ratio, Estimator::paper).theta,
              (ends.front().theta + ends.back().theta) / 2, 1e-12);
  const double sum = 0.875 * std::min(ratio, 1.0);
  EXPECT_NEAR(point_on_contour(ratio, Estimator::direct).theta,
              std::atan2(std::hypot(2 * ratio - sum, 2 - sum), sum), 1e-12);
}

TEST_P(Contour, HalfWidthsAreHalfOfItsExtent) {
  const std::vector<Angles> ends = contour(GetParam(), 2);
  const Angles half = half_widths(GetParam());
  EXPECT_NEAR(half.theta, std::abs(ends.front().theta - ends.back().theta) / 2, 1e-12);
  EXPECT_NEAR(half.phi, std::abs(ends.front().phi - ends.back().phi) / 2, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Ratios, Contour,
                         testing::Values(0.01, 0.125, 0.5, 2.0 / 3, 1.0, 2.0, 7.0, 100.0));

TEST(HalfWidths, HaveTheLargestValuesOfTheDesign) {
  double theta = 0;
  double phi = 0;
  for (int step = -200; step <= 200; ++step) {
    const Angles half = half_widths(std::pow(10, step / 100.0));
    theta = std::max(theta, half.theta);
    phi = std::max(phi, half.phi);
  }
  EXPECT_NEAR(theta, std::atan(std::sqrt(0.5)) / 2, 1e-9);
  EXPECT_NEAR(phi, std::atan(1.0 / 7) / 2, 1e-5);
}

// docs/testbed.md derives it to first order: dF/F = - sum g (dg/dtheta dtheta + dg/dphi dphi) / sum
// g², which is largest at a corner of the box.
TEST(MagnitudeBand, IsTheFirstOrderOfEquationTwo) {
  constexpr double kSmall = 1e-4;
  for (const Site& site : kSites) {
    double square = 0;
    double by_theta = 0;
    double by_phi = 0;
    for (int n = 1; n <= 4; ++n) {
      const double angle = kPi / 4 * (2 * n - 1) - site.phi_rad;
      const double g = bracket(n, site.theta_rad, site.phi_rad);
      if (g <= 0) continue;
      square += g * g;
      by_theta += g * (-std::sin(site.theta_rad) - std::cos(site.theta_rad) * std::cos(angle));
      by_phi += g * (-std::sin(site.theta_rad) * std::sin(angle));
    }
    const double relative = kSmall * (std::abs(by_theta) + std::abs(by_phi)) / square;
    const MagnitudeBand band = magnitude_band(site, kSmall);
    EXPECT_NEAR(band.high - 1, relative, 1e-3 * relative + 1e-8) << site.name;
    EXPECT_NEAR(1 - band.low, relative, 1e-3 * relative + 1e-8) << site.name;
  }
}

TEST(MagnitudeBand, HoldsTheTruthAndClosesWithoutUncertainty) {
  for (const Site& site : kSites) {
    const MagnitudeBand band = magnitude_band(site, 0.05);
    EXPECT_LT(band.low, 1);
    EXPECT_GT(band.high, 1);
    EXPECT_NEAR(magnitude_band(site, 0).low, 1, 1e-12);
    EXPECT_NEAR(magnitude_band(site, 0).high, 1, 1e-12);
  }
}

TEST(MagnitudeFigure, HoldsTheTruthInItsIntervals) {
  for (const auto& site : magnitude_figure({})) {
    for (const MagnitudePoint& point : site) {
      // Noise and the probe's resolution are not in the interval.
      EXPECT_LE(point.possible.low, point.applied_n + 0.2);
      EXPECT_GE(point.possible.high, point.applied_n - 0.2);
      EXPECT_LE(point.possible.low, point.direct_n + 1e-9);
      EXPECT_GE(point.possible.high, point.direct_n - 1e-9);
    }
  }
}

}  // namespace
}  // namespace pillarfield::testbed
