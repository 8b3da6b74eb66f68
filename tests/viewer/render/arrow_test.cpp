// Arrows of known forces, measured in pixels.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/viewer/render/drawing.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kSide = 400;
constexpr double kDegree = std::numbers::pi / 180;

/// Moments of the bright pixels.
struct Shape {
  double x = 0, y = 0;   ///< mean; pixels, y down
  double direction = 0;  ///< of the longer axis towards the thicker end; rad, y up
  double length = 0;     ///< along that axis, pixels
  std::size_t pixels = 0;
};

struct Point {
  double x, y;
};

std::vector<Point> bright_pixels(const Pixels& pixels) {
  std::vector<Point> points;
  for (std::uint32_t y = 0; y < pixels.height; ++y) {
    for (std::uint32_t x = 0; x < pixels.width; ++x) {
      const Colour colour = colour_at(pixels, x, y);
      if (colour.red > 200 && colour.green > 200 && colour.blue > 200)
        points.push_back({x + 0.5, y + 0.5});
    }
  }
  return points;
}

Shape shape_of(const Pixels& pixels) {
  const auto points = bright_pixels(pixels);
  Shape shape;
  shape.pixels = points.size();
  if (points.empty()) return shape;
  for (const Point& point : points) {
    shape.x += point.x / static_cast<double>(points.size());
    shape.y += point.y / static_cast<double>(points.size());
  }
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for (const Point& point : points) {
    const double dx = point.x - shape.x;
    const double dy = shape.y - point.y;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  shape.direction = 0.5 * std::atan2(2 * xy, xx - yy);
  const double c = std::cos(shape.direction);
  const double s = std::sin(shape.direction);
  double least = 0;
  double most = 0;
  for (const Point& point : points) {
    const double along = c * (point.x - shape.x) + s * (shape.y - point.y);
    least = std::min(least, along);
    most = std::max(most, along);
  }
  shape.length = most - least;
  // The mean lies nearer to the head, which has most pixels.
  if (most > -least) shape.direction += std::numbers::pi;
  return shape;
}

double turn_between(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi));
}

/// One pressed pillar of 3 x 3 in a top view; its arrow is 150 pixels long at full force.
MadeUpField one_pillar(float shear_x, float shear_y, float normal = 0.5F) {
  return {3, 3, [=](std::uint32_t row, std::uint32_t col) {
            if (row != 1 || col != 1) return MadeUpPillar{0, 0, 0, 0};
            return MadeUpPillar{shear_x, shear_y, normal, 15};
          }};
}

RenderSettings arrow_look(const MadeUpField& field) {
  RenderSettings settings = bare_settings(field, kSide, kSide);
  settings.arrows = true;
  settings.full_shear_n = 1;
  settings.range = {0, 100};  // Dark, so that only arrows are bright.
  settings.scale = 2;
  return settings;
}

TEST(Arrows, PointWhereTheShearActs) {
  Drawing drawing;
  for (int step = 0; step < 24; ++step) {
    const double direction = (15 * step + 4) * kDegree;
    const MadeUpField field = one_pillar(static_cast<float>(std::cos(direction)),
                                         static_cast<float>(std::sin(direction)));
    const RenderSettings settings = arrow_look(field);
    const Shape shape = shape_of(drawing.draw(field, settings, kSide, kSide));
    ASSERT_GT(shape.pixels, 100U);
    EXPECT_LT(turn_between(shape.direction, direction), 1.5 * kDegree) << "step " << step;
    const double cell = pixels_per_mm(settings.view, {0, 0, kSide, kSide}) * 1.0;
    EXPECT_NEAR(shape.length, 1.5 * cell, 0.03 * cell);
  }
  EXPECT_EQ(drawing.validation_messages(), 0);
}

TEST(Arrows, AreAsLongAsTheForceAndHaveALeastLength) {
  Drawing drawing;
  const auto length_of = [&](float shear) {
    const MadeUpField field = one_pillar(shear, 0);
    return shape_of(drawing.draw(field, arrow_look(field), kSide, kSide)).length;
  };
  EXPECT_NEAR(length_of(0.5F) / length_of(1), 0.5, 0.02);
  EXPECT_GT(length_of(0.02F), 8);
  EXPECT_LT(length_of(0.02F), 14);
  EXPECT_EQ(length_of(0), 0);
}

TEST(Arrows, FromAfarAddWhatLiesUnderTheirCell) {
  // 96 x 96 pillars on 400 pixels: cells of several pillars, whose shears cancel to a quarter.
  const auto mean_length = [](float other) {
    const MadeUpField field(96, 96, [other](std::uint32_t row, std::uint32_t col) {
      if (row < 40 || row >= 48 || col < 40 || col >= 48) return MadeUpPillar{0, 0, 0, 0};
      return MadeUpPillar{(row + col) % 2 == 0 ? 1.0F : other, 0, 0.1F, 15};
    });
    Drawing drawing;
    RenderSettings settings = arrow_look(field);
    settings.scale = 1;
    settings.arrow_cell = 28;  // Blocks of 8.
    EXPECT_EQ(arrow_block_of(settings, {0, 0, kSide, kSide}, 1.0), 8U);
    return shape_of(drawing.draw(field, settings, kSide, kSide)).length;
  };
  const double cell = 8 * 400 * 0.92 / 96;
  EXPECT_NEAR(mean_length(1.0F), 1.5 * cell, 2.5);
  EXPECT_NEAR(mean_length(-0.5F), 1.5 * cell / 4, 2.5);
}

}  // namespace
}  // namespace pillarfield::viewer
