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

TEST(Arrows, AreAsLongAsTheForce) {
  Drawing drawing;
  const MadeUpField full = one_pillar(1, 0);
  const MadeUpField half = one_pillar(0.5F, 0);
  const double full_length = shape_of(drawing.draw(full, arrow_look(full), kSide, kSide)).length;
  const double half_length = shape_of(drawing.draw(half, arrow_look(half), kSide, kSide)).length;
  EXPECT_NEAR(half_length / full_length, 0.5, 0.02);
}

TEST(Arrows, HaveALeastLengthAndVanishWithoutForce) {
  Drawing drawing;
  const MadeUpField faint = one_pillar(0.02F, 0);
  const Shape shape = shape_of(drawing.draw(faint, arrow_look(faint), kSide, kSide));
  EXPECT_GT(shape.length, 8);
  EXPECT_LT(shape.length, 14);
  const MadeUpField pressed = one_pillar(0, 0, 0.7F);
  EXPECT_EQ(shape_of(drawing.draw(pressed, arrow_look(pressed), kSide, kSide)).pixels, 0U);
  const MadeUpField idle(3, 3, [](auto, auto) { return MadeUpPillar{1, 1, 1, 0}; });
  EXPECT_EQ(shape_of(drawing.draw(idle, arrow_look(idle), kSide, kSide)).pixels, 0U);
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

TEST(Arrows, AddNothingOfTheNextCell) {
  // Cells of 3 x 3 pillars, not aligned with words of four statuses. The shears in the two cells
  // beside the middle one cancel, so they have no arrow despite strong forces.
  const MadeUpField field(30, 30, [](std::uint32_t row, std::uint32_t col) {
    if (row < 9 || row >= 12 || col < 6 || col >= 15) return MadeUpPillar{0, 0, 0, 0};
    const std::array<float, 9> shears{-1, 0, 1, 0.5F, 0.5F, 0.5F, 1, 0, -1};
    return MadeUpPillar{shears.at(col - 6), 0, 0.1F, 15};
  });
  Drawing drawing;
  RenderSettings settings = arrow_look(field);
  settings.scale = 1;
  settings.arrow_cell = 30;
  EXPECT_EQ(arrow_block_of(settings, {0, 0, kSide, kSide}, 1.0), 3U);
  const double cell = 3 * 400 * 0.92 / 30;
  EXPECT_NEAR(shape_of(drawing.draw(field, settings, kSide, kSide)).length, 1.5 * cell / 2, 2.5);
}

TEST(Arrows, InSpaceAreTheForceThatActsOnTheSkin) {
  Drawing drawing;
  struct Case {
    float shear_x, shear_y, normal;
  };
  for (const Case& force : {Case{1, 0, 0.3F}, Case{0, 1, 0.5F}, Case{0, 0, 1},
                            Case{-0.7F, 0.4F, 0.6F}, Case{0.3F, -0.9F, 0.2F}}) {
    const MadeUpField field = one_pillar(force.shear_x, force.shear_y, force.normal);
    RenderSettings settings = arrow_look(field);
    settings.full_force_n = 3;
    const SkinSize size = skin_size(field.source());
    const Viewport plot{0, 0, kSide, kSide};
    for (const Surface& surface : {Surface{}, Surface{SurfaceKind::cylinder, 2}}) {
      settings.surface = surface;
      settings.view = fit_orbit(size, surface, plot);
      std::get<OrbitView>(settings.view).distance_mm *= 0.4;
      const double mm = 1.5 / 3;  // Length of 1 N in cells of one pillar, 1 mm wide.
      const auto tip = project(settings.view, surface, size, plot, {0, 0, 0});
      const auto tail = project(settings.view, surface, size, plot,
                                {-mm * force.shear_x, -mm * force.shear_y, mm * force.normal});
      ASSERT_TRUE(tip && tail);
      const double direction = std::atan2(tail->y - tip->y, tip->x - tail->x);
      const double length = std::hypot(tip->x - tail->x, tip->y - tail->y);
      const Shape shape = shape_of(drawing.draw(field, settings, kSide, kSide));
      EXPECT_LT(turn_between(shape.direction, direction), 4 * kDegree)
          << force.shear_x << ' ' << force.shear_y << ' ' << force.normal;
      EXPECT_NEAR(shape.length, length, 4);
    }
  }
}

TEST(Sectors, SpanTheDirectionsAnAmbiguousPillarMayHave) {
  Drawing drawing;
  const auto draw = [&](std::uint8_t status, bool sectors) {
    const MadeUpField field(3, 3, [=](std::uint32_t row, std::uint32_t col) {
      const bool middle = row == 1 && col == 1;
      return MadeUpPillar{middle ? 1.0F : 0.0F, 0, middle ? 0.2F : 0.0F,
                          static_cast<std::uint8_t>(middle ? status : 0)};
    });
    RenderSettings settings = arrow_look(field);
    settings.sectors = sectors;
    return drawing.draw(field, settings, kSide, kSide).rgba;
  };
  EXPECT_NE(draw(3 | 16, true), draw(3 | 16, false));
  EXPECT_EQ(draw(15, true), draw(15, false));
}

}  // namespace
}  // namespace pillarfield::viewer
