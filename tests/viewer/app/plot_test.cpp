// Plots: positions of values; curves and shares on whole pixels.
#include "viewer/app/panels/plot.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

PanelStyle style_of(double scale) {
  PanelStyle style{};
  style.unit = scale;
  style.line = 16 * scale;
  return style;
}

TEST(PlotArea, ValuesAtTheEndsLieInTheCorners) {
  const PlotArea area{{10, 20, 100, 50}, {-2, 6}, {1, 3}};
  EXPECT_DOUBLE_EQ(area.at({-2, 1}).x, 10);
  EXPECT_DOUBLE_EQ(area.at({-2, 1}).y, 70);
  EXPECT_DOUBLE_EQ(area.at({6, 3}).x, 110);
  EXPECT_DOUBLE_EQ(area.at({6, 3}).y, 20);
}

TEST(PlotArea, PixelsLeadBackToValues) {
  const PlotArea area{{10, 20, 137, 51}, {-2, 6}, {1, 3}};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> any(-10, 10);
  for (int i = 0; i < 200; ++i) {
    const Vec2 value{any(random), any(random)};
    const Vec2 back = area.value_at(area.at(value));
    EXPECT_NEAR(back.x, value.x, 1e-9);
    EXPECT_NEAR(back.y, value.y, 1e-9);
  }
}

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

TEST(InsideAxes, LeavesRoomForLabelsAndGrowsWithTheScale) {
  for (const double scale : {1.0, 1.5, 2.0}) {
    const Viewport outer{5, 7, 300 * scale, 120 * scale};
    const Viewport box = inside_axes(outer, 30 * scale, style_of(scale));
    EXPECT_GE(box.x, outer.x + 30 * scale);
    EXPECT_LE(box.x + box.width, outer.x + outer.width);
    EXPECT_LE(box.y + box.height + 16 * scale, outer.y + outer.height);
    EXPECT_GT(box.width, 240 * scale);
    EXPECT_GT(box.height, 80 * scale);
  }
  EXPECT_GE(inside_axes({0, 0, 3, 3}, 30, style_of(1)).width, 1);
}

TEST(TicksOf, AreFewerInASmallerPlot) {
  const PlotArea wide{{0, 0, 600, 300}, {0, 10}, {0, 1}};
  const PlotArea narrow{{0, 0, 130, 40}, {0, 10}, {0, 1}};
  const PlotTicks many = ticks_of(wide, style_of(1));
  const PlotTicks few = ticks_of(narrow, style_of(1));
  EXPECT_GT(many.x.size(), few.x.size());
  EXPECT_GT(many.y.size(), few.y.size());
  EXPECT_GE(few.x.size(), 1u);
  EXPECT_GE(few.y.size(), 2u);
}

}  // namespace
}  // namespace pillarfield::viewer
