#include "viewer/style/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace pillarfield::viewer {
namespace {

Surface cylinder(double radius_mm, double axis_deg = 90) {
  return {SurfaceShape::cylinder, radius_mm, axis_deg, {}};
}
Surface sphere(double radius_mm) { return {SurfaceShape::sphere, radius_mm, 90, {}}; }

std::vector<Surface> all_surfaces() {
  return {{},
          cylinder(3),
          cylinder(40),
          cylinder(5000),
          cylinder(-50, 30),
          cylinder(70, -120),
          sphere(120),
          sphere(-3000)};
}

/// The ray from outside or inside through a point hits that point.
TEST(FirstHit, FindsThePointOfEverySurface) {
  std::mt19937 random(4);
  const SkinSize skin{90, 60};
  for (const Surface& surface : all_surfaces()) {
    if (surface.radius_mm == 3) continue;  // The sheet winds around it.
    std::uniform_real_distribution<double> share(-0.499, 0.499);
    for (int i = 0; i < 200; ++i) {
      const double x = share(random) * skin.width_mm;
      const Vec2 point{x, share(random) * skin.height_mm};
      const Pose frame = pose_at(surface, point);
      for (const double side : {-1.0, 1.0}) {
        const Ray ray{frame.position_mm + side * 5 * frame.normal, (-side) * frame.normal};
        const auto hit = first_hit(ray, surface, skin);
        ASSERT_TRUE(hit.has_value());
        EXPECT_NEAR(hit->x, point.x, 1e-9);
        EXPECT_NEAR(hit->y, point.y, 1e-9);
      }
      const Box box = box_about(skin, surface);
      for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        EXPECT_GE(frame.position_mm.*axis, box.low.*axis - 1e-9);
        EXPECT_LE(frame.position_mm.*axis, box.high.*axis + 1e-9);
      }
    }
  }
}

TEST(FirstHit, IsTheNearestOfSkinOnEitherSide) {
  const Surface surface = cylinder(20);
  const Ray from_above{{5, 0, 100}, {0, 0, -1}};
  const Ray from_below{{5, 0, -100}, {0, 0, 1}};
  const double there = 20 * std::asin(0.25);
  // A skin over the upper half only, and one around the whole cylinder.
  EXPECT_NEAR(first_hit(from_above, surface, {60, 10})->x, there, 1e-12);
  EXPECT_NEAR(first_hit(from_below, surface, {60, 10})->x, there, 1e-12) << "its inner side";
  EXPECT_NEAR(first_hit(from_below, surface, {130, 10})->x, 20 * std::numbers::pi - there, 1e-12);
  EXPECT_FALSE(first_hit({{5, 0, 100}, {0, 0, 1}}, surface, {60, 10})) << "behind";
  EXPECT_FALSE(first_hit({{21, 0, 100}, {0, 0, -1}}, surface, {60, 10})) << "beside";
  EXPECT_FALSE(first_hit({{5, 6, 100}, {0, 0, -1}}, surface, {60, 10})) << "beyond its edge";
  EXPECT_FALSE(first_hit({{0, -100, 0}, {0, 1, 0}}, surface, {60, 10})) << "along the axis";
}

}  // namespace
}  // namespace pillarfield::viewer
