#include "viewer/style/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "glsl_types.h"
#include "viewer/style/vectors.h"

namespace glsl {
#include "shaders/surface.glsl"
}  // namespace glsl

namespace pillarfield::viewer {
namespace {

Surface cylinder(double radius_mm) { return {SurfaceKind::cylinder, radius_mm}; }

/// Surfaces that keep lengths.
const Surface kSheets[] = {{},
                           cylinder(3),
                           cylinder(40),
                           cylinder(5000),
                           {SurfaceKind::cylinder, -50, 30},
                           {SurfaceKind::cylinder, 70, -120}};
const Surface kSpheres[] = {{SurfaceKind::sphere, 120}, {SurfaceKind::sphere, -3000}};

std::vector<Surface> all_surfaces() {
  std::vector<Surface> all(std::begin(kSheets), std::end(kSheets));
  all.insert(all.end(), std::begin(kSpheres), std::end(kSpheres));
  return all;
}

Vec2 random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-120, 120);
  const double x = place(random);
  return {x, place(random)};
}

TEST(Surface, FramesAreOrthonormalAndRightHanded) {
  std::mt19937 random(1);
  for (const Surface& surface : all_surfaces()) {
    for (int i = 0; i < 200; ++i) {
      const auto [position, x, y, n] = frame_at(surface, random_point(random));
      EXPECT_NEAR(dot(x, x), 1, 1e-14);
      EXPECT_NEAR(dot(y, y), 1, 1e-14);
      EXPECT_NEAR(dot(n, n), 1, 1e-14);
      EXPECT_NEAR(dot(x, y), 0, 1e-14);
      EXPECT_NEAR(dot(y, n), 0, 1e-14);
      EXPECT_NEAR(dot(x, n), 0, 1e-14);
      EXPECT_NEAR(x.y * y.z - x.z * y.y, n.x, 1e-14);
      EXPECT_NEAR(x.x * y.y - x.y * y.x, n.z, 1e-14);
    }
  }
}

TEST(Surface, TangentsAreTheDerivativesSoThatLengthsAreKept) {
  std::mt19937 random(2);
  constexpr double kStep = 1e-5;
  for (const Surface& surface : kSheets) {
    for (int i = 0; i < 200; ++i) {
      const Vec2 at = random_point(random);
      const SurfaceFrame frame = frame_at(surface, at);
      const auto slope = [&](Vec2 after, Vec2 before) {
        const Vec3 way = frame_at(surface, after).position - frame_at(surface, before).position;
        return 1 / (2 * kStep) * way;
      };
      const Vec3 along_x = slope({at.x + kStep, at.y}, {at.x - kStep, at.y});
      const Vec3 along_y = slope({at.x, at.y + kStep}, {at.x, at.y - kStep});
      EXPECT_LT(length(along_x - frame.tangent_x), 1e-8);
      EXPECT_LT(length(along_y - frame.tangent_y), 1e-8);
    }
  }
}

TEST(Surface, CylinderHasItsCrestInTheMiddleAndBendsDown) {
  const SurfaceFrame crest = frame_at(cylinder(40), {0, 7});
  EXPECT_EQ(length(crest.position - Vec3{0, 7, 0}), 0);
  EXPECT_EQ(crest.normal.z, 1);
  const SurfaceFrame quarter = frame_at(cylinder(40), {40 * std::numbers::pi / 2, 7});
  EXPECT_LT(length(quarter.position - Vec3{40, 7, -40}), 1e-12);
  EXPECT_LT(length(quarter.normal - Vec3{1, 0, 0}), 1e-12);
}

TEST(Surface, AHugeCylinderIsNearlyAPlaneWithAHeightToItsLastDigit) {
  const SurfaceFrame frame = frame_at(cylinder(1e9), {100, 20});
  EXPECT_NEAR(frame.position.x, 100, 1e-9);
  EXPECT_NEAR(frame.position.z / (-100.0 * 100 / 2e9), 1, 1e-9);
}

TEST(Surface, ACylinderWithoutRadiusIsAPlane) {
  for (const double radius : {0.0, -1e-9, 1e-9, std::nan("")}) {
    const SurfaceFrame frame = frame_at(cylinder(radius), {100, 20});
    EXPECT_EQ(length(frame.position - Vec3{100, 20, 0}), 0);
    EXPECT_EQ(frame.normal.z, 1);
  }
}

TEST(SurfaceShader, IsTheSameFunctionInSinglePrecision) {
  std::mt19937 random(3);
  for (const Surface& surface : all_surfaces()) {
    for (int i = 0; i < 500; ++i) {
      const Vec2 at = random_point(random);
      const SurfaceFrame frame = frame_at(surface, at);
      const glsl::vec2 sheet{static_cast<float>(at.x), static_cast<float>(at.y)};
      const auto [x, y, radius, kind] = shader_surface(surface);
      const glsl::vec4 bent{x, y, radius, kind};
      const auto distance = [](glsl::vec3 single, Vec3 exact) {
        return length(Vec3{single.x, single.y, single.z} - exact);
      };
      EXPECT_LT(distance(glsl::surface_position(sheet, bent), frame.position), 5e-5);
      const auto basis = glsl::surface_basis(sheet, bent);
      EXPECT_LT(distance(basis.first, frame.tangent_x), 1e-5);
      EXPECT_LT(distance(basis.second, frame.tangent_y), 1e-5);
      EXPECT_LT(distance(basis.third, frame.normal), 1e-5);
    }
  }
}

TEST(SurfaceShader, TakesASurfaceWithoutARadiusAsAPlane) {
  for (const double radius : {0.0, -1e-4, 1e-20, std::nan("")}) {
    EXPECT_EQ(shader_surface(cylinder(radius))[3], 0);
  }
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
      const SurfaceFrame frame = frame_at(surface, point);
      for (const double side : {-1.0, 1.0}) {
        const Ray ray{frame.position + side * 5 * frame.normal, (-side) * frame.normal};
        const auto hit = first_hit(ray, surface, skin);
        ASSERT_TRUE(hit.has_value());
        EXPECT_NEAR(hit->x, point.x, 1e-9);
        EXPECT_NEAR(hit->y, point.y, 1e-9);
      }
      const Box box = box_about(skin, surface);
      for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
        EXPECT_GE(frame.position.*axis, box.low.*axis - 1e-9);
        EXPECT_LE(frame.position.*axis, box.high.*axis + 1e-9);
      }
    }
  }
}

TEST(BoxAbout, HoldsTheSkinTightly) {
  const SkinSize skin{100, 60};
  for (const double radius : {0.0, 10.0, 20.0, 40.0, 1000.0}) {
    const Surface surface = cylinder(radius);
    const Box box = box_about(skin, surface);
    Vec3 low{1e9, 1e9, 1e9};
    Vec3 high{-1e9, -1e9, -1e9};
    for (int i = -500; i <= 500; ++i) {
      const Vec3 place = frame_at(surface, {0.1 * i, i % 2 == 0 ? 30.0 : -30.0}).position;
      low = {std::min(low.x, place.x), std::min(low.y, place.y), std::min(low.z, place.z)};
      high = {std::max(high.x, place.x), std::max(high.y, place.y), std::max(high.z, place.z)};
    }
    EXPECT_LT(length(box.low - low), 0.01) << radius;
    EXPECT_LT(length(box.high - high), 0.01) << radius;
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
