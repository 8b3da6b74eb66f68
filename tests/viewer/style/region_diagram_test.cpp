#include "viewer/style/region_diagram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solve/pillar_maths.h"

namespace pillarfield::viewer {
namespace {

constexpr double kPi = std::numbers::pi;

/// Reading of sensel 1..4 under 1 N at 1 count per newton, by kernels/pillar.
double reading_under(int sensel, Vec2 phi_theta) {
  const double sine = std::sin(phi_theta.y);
  const double_precision::Force force = {-sine * std::cos(phi_theta.x),
                                         -sine * std::sin(phi_theta.x), std::cos(phi_theta.y)};
  const auto readings = double_precision::model_readings(force, 1);
  const double all[] = {readings.v1, readings.v2, readings.v3, readings.v4};
  return all[sensel - 1];
}

TEST(RegionBorders, AreWhereTheirSenselReadsNothing) {
  for (const int points : {8, 100, 361}) {
    const auto borders = region_borders(points);
    for (int sensel = 1; sensel <= 4; ++sensel) {
      for (const auto& piece : borders.at(static_cast<std::size_t>(sensel - 1))) {
        for (const Vec2& point : piece) {
          EXPECT_NEAR(reading_under(sensel, point), 0, 1e-14);
          EXPECT_LE(std::abs(point.x), kPi);
          EXPECT_GE(point.y, kPi / 4 - 1e-14);
          EXPECT_LE(point.y, kPi / 2);
        }
      }
    }
  }
}

TEST(RegionBorders, SeparateActiveFromInactiveReadings) {
  const auto borders = region_borders(50);
  for (int sensel = 1; sensel <= 4; ++sensel) {
    for (const auto& piece : borders.at(static_cast<std::size_t>(sensel - 1))) {
      for (const Vec2& point : piece) {
        EXPECT_GT(reading_under(sensel, {point.x, point.y - 1e-3}), 0);
        if (point.y < kPi / 2 - 2e-3) {
          EXPECT_LT(reading_under(sensel, {point.x, point.y + 1e-3}), 0);
        }
      }
    }
  }
}

TEST(RegionBorders, HaveTheirPointsInAscendingPhiFromEdgeToEdge) {
  for (const int points : {4, 5, 64, 100}) {
    const auto borders = region_borders(points);
    for (const auto& pieces : borders) {
      std::size_t total = 0;
      double last = -4;
      double length = 0;
      for (const auto& piece : pieces) {
        ASSERT_GE(piece.size(), 2U);
        total += piece.size();
        for (const Vec2& point : piece) {
          EXPECT_GT(point.x, last);
          last = point.x;
        }
        for (const Vec2& end : {piece.front(), piece.back()}) {
          EXPECT_TRUE(end.y == kPi / 2 || std::abs(end.x) == kPi) << end.x << " " << end.y;
        }
        length += piece.back().x - piece.front().x;
      }
      EXPECT_NEAR(length, kPi, 1e-12) << "each border spans half a turn";
      EXPECT_LE(total, static_cast<std::size_t>(points) + 1);
    }
  }
}

TEST(RegionBorders, OfTheLeftSenselsGoOverTheDiagramsEdge) {
  const auto borders = region_borders(64);
  EXPECT_EQ(borders[0].size(), 1U);
  EXPECT_EQ(borders[1].size(), 2U);
  EXPECT_EQ(borders[2].size(), 2U);
  EXPECT_EQ(borders[3].size(), 1U);
  for (const auto& pieces : {borders[1], borders[2]}) {
    EXPECT_EQ(pieces[0].front().x, -kPi);
    EXPECT_EQ(pieces[1].back().x, kPi);
    EXPECT_NEAR(pieces[0].front().y, pieces[1].back().y, 1e-14);
  }
}

struct Pair {
  int sensel;
  double reading, next_reading;
};

std::vector<Pair> random_pairs() {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> logarithm(-2, 4);
  std::vector<Pair> pairs;
  pairs.reserve(400);
  for (int i = 0; i < 400; ++i) {
    pairs.push_back({1 + i % 4, std::pow(10, logarithm(random)), std::pow(10, logarithm(random))});
  }
  return pairs;
}

TEST(AmbiguityContour, ExplainsTheReadings) {
  for (const auto& [sensel, reading, next_reading] : random_pairs()) {
    const auto contour = ambiguity_contour(sensel, reading, next_reading, 33);
    ASSERT_EQ(contour.size(), 33U);
    for (const Vec2& point : contour) {
      const double first = reading_under(sensel, point);
      const double second = reading_under(sensel % 4 + 1, point);
      EXPECT_NEAR(first * next_reading, second * reading, 1e-13 * (reading + next_reading))
          << "in their ratio";
      EXPECT_GT(first + second, 0);
      EXPECT_LE(reading_under((sensel + 1) % 4 + 1, point), 1e-13) << "inactive";
      EXPECT_LE(reading_under((sensel + 2) % 4 + 1, point), 1e-13) << "inactive";
    }
  }
}

TEST(AmbiguityContour, GoesFromThePlaneToTheBorderOfItsRegion) {
  for (const auto& [sensel, reading, next_reading] : random_pairs()) {
    const auto contour = ambiguity_contour(sensel, reading, next_reading, 20);
    EXPECT_NEAR(contour.front().y, kPi / 2, 1e-14);
    const int third = reading < next_reading ? (sensel + 1) % 4 + 1 : (sensel + 2) % 4 + 1;
    EXPECT_NEAR(reading_under(third, contour.back()), 0, 1e-13) << "the weaker one's opposite";
    for (std::size_t i = 1; i < contour.size(); ++i) {
      EXPECT_LT(contour[i].y, contour[i - 1].y);
      EXPECT_LT(std::abs(contour[i].x - contour[i - 1].x), 0.1) << "continuous";
    }
  }
}

TEST(AmbiguityContour, LiesAboutTheMiddleOfItsRegion) {
  constexpr double kMiddles[] = {-kPi / 2, 0, kPi / 2, kPi};
  for (int sensel = 1; sensel <= 4; ++sensel) {
    const auto contour = ambiguity_contour(sensel, 10, 10, 5);
    for (const Vec2& point : contour) {
      EXPECT_NEAR(std::abs(std::remainder(point.x - kMiddles[sensel - 1], 2 * kPi)), 0, 1e-14);
      EXPECT_LE(std::abs(point.x), kPi + 1e-12);
    }
  }
}

TEST(AmbiguityContour, HasTheHalfWidthsOfTheDesign) {
  double widest_theta = 0;
  double widest_phi = 0;
  for (int step = -2304; step <= 2304; ++step) {
    const double ratio = std::pow(1.001, step);  // 0.1 to 10
    const auto contour = ambiguity_contour(3, ratio, 1, 2);
    widest_theta = std::max(widest_theta, (contour[0].y - contour[1].y) / 2);
    widest_phi = std::max(widest_phi, std::abs(contour[0].x - contour[1].x) / 2);
  }
  EXPECT_NEAR(widest_theta, 0.3077, 5e-5);
  EXPECT_NEAR(widest_phi, 0.0709, 5e-5);
}

TEST(AmbiguityContour, OfOneReadingIsAPointAndOfNoneNothing) {
  for (const Vec2& point : ambiguity_contour(2, 5, 0, 4)) {
    EXPECT_NEAR(point.y, kPi / 2, 1e-14);
    EXPECT_NEAR(std::remainder(point.x + kPi / 4, 2 * kPi), 0, 1e-14) << "opposite to sensel 2";
  }
  EXPECT_TRUE(ambiguity_contour(2, 0, 0, 4).empty());
}

}  // namespace
}  // namespace pillarfield::viewer
