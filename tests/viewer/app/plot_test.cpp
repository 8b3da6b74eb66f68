// Plots: ends of axes; curves and shares on whole pixels.
#include "viewer/app/panels/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace pillarfield::viewer {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

TEST(RoundSpan, HoldsZeroAndAllValuesTightly) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> exponent(-6, 6);
  std::normal_distribution<double> sign(0.5, 1);
  for (int i = 0; i < 500; ++i) {
    std::vector<double> values(4);
    for (double& value : values) value = sign(random) * std::pow(10, exponent(random));
    const Span span = round_span(values);
    const auto [low, high] = std::minmax({values[0], values[1], values[2], values[3]});
    const double width = std::max(high, 0.0) - std::min(low, 0.0);
    EXPECT_LE(span.from, std::min(low, 0.0));
    EXPECT_GE(span.to, std::max(high, 0.0));
    // At most one step at each end, and a step is at most half of the range.
    EXPECT_LE(span.to - span.from, 2.01 * width);
    EXPECT_GE(ticks(span.from, span.to, 8).size(), 3u);
  }
}

TEST(RoundSpan, IsAUnitWhereThereIsNothing) {
  for (const std::vector<double>& values : {std::vector<double>{}, {0, 0}, {kNoNumber}}) {
    EXPECT_EQ(round_span(values).from, 0);
    EXPECT_EQ(round_span(values).to, 1);
  }
}

std::vector<Vec2> walk(std::size_t points) {
  std::mt19937 random(11);
  std::normal_distribution<double> step;
  std::vector<Vec2> curve;
  double y = 0;
  for (std::size_t i = 0; i < points; ++i) {
    y += step(random);
    curve.push_back({static_cast<double>(i) / static_cast<double>(points), y});
  }
  return curve;
}

TEST(Thinned, KeepsTheExtremesOfEachColumnAndNoMoreThanFourPoints) {
  const PlotArea area{{0.25, 0, 100, 60}, {0, 1}, {-80, 80}};
  const std::vector<Vec2> curve = walk(20000);
  const std::vector<Vec2> points = thinned(curve, area);
  ASSERT_LE(points.size(), 4u * 101);
  for (int column = 0; column <= 100; ++column) {
    double lowest = 1e9;
    double highest = -1e9;
    double thin_lowest = 1e9;
    double thin_highest = -1e9;
    for (const Vec2& value : curve) {
      const Vec2 pixel = area.at(value);
      if (std::floor(pixel.x) != column) continue;
      lowest = std::min(lowest, pixel.y);
      highest = std::max(highest, pixel.y);
    }
    for (const Vec2& pixel : points) {
      if (std::floor(pixel.x) != column) continue;
      thin_lowest = std::min(thin_lowest, pixel.y);
      thin_highest = std::max(thin_highest, pixel.y);
    }
    EXPECT_EQ(thin_lowest, lowest) << column;
    EXPECT_EQ(thin_highest, highest) << column;
  }
}

TEST(Thinned, BeginsEndsAndAscendsAsTheCurve) {
  const PlotArea area{{3, 0, 50, 60}, {0, 1}, {-80, 80}};
  const std::vector<Vec2> curve = walk(5000);
  const std::vector<Vec2> points = thinned(curve, area);
  EXPECT_EQ(points.front().x, area.at(curve.front()).x);
  EXPECT_EQ(points.back().y, area.at(curve.back()).y);
  EXPECT_TRUE(std::ranges::is_sorted(points, {}, &Vec2::x));
}

TEST(Thinned, LeavesFewPointsAsTheyAre) {
  const PlotArea area{{0, 0, 100, 60}, {0, 1}, {-80, 80}};
  const std::vector<Vec2> curve = walk(50);
  ASSERT_EQ(thinned(curve, area).size(), curve.size());
  EXPECT_TRUE(thinned({}, area).empty());
}

TEST(Thinned, SkipsNan) {
  const PlotArea area{{0, 0, 100, 60}, {0, 1}, {-1, 1}};
  const std::vector<Vec2> curve{{0, kNoNumber}, {0.5, 0}, {0.7, kNoNumber}, {1, 1}};
  EXPECT_EQ(thinned(curve, area).size(), 2u);
}

TEST(SharesOf, FillTheWidthInProportionAndHideNobody) {
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    std::vector<std::uint64_t> counts(5);
    for (std::uint64_t& count : counts) count = random() % 4 == 0 ? 0 : random() % 1000000;
    const auto total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
    const std::vector<int> widths = shares_of(counts, 200);
    EXPECT_EQ(std::accumulate(widths.begin(), widths.end(), 0), total == 0 ? 0 : 200);
    for (std::size_t k = 0; k < counts.size() && total > 0; ++k) {
      const double exact = 200 * static_cast<double>(counts[k]) / static_cast<double>(total);
      EXPECT_NEAR(widths[k], exact, 5);
      EXPECT_EQ(widths[k] > 0, counts[k] > 0);
    }
  }
}

}  // namespace
}  // namespace pillarfield::viewer
