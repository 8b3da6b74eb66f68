#include "pillarfield/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pillarfield/error.h"
#include "skin/vectors.h"

namespace pillarfield {
namespace {

constexpr ElementGrid kPillars = {17, 30, 1.25};

Surface shaped(SurfaceShape shape, double radius_mm, double axis_deg = 90) {
  Surface surface;
  surface.shape = shape;
  surface.radius_mm = radius_mm;
  surface.axis_deg = axis_deg;
  return surface;
}

void expect_equal(Vector3 a, Vector3 b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

Surface wavy() {
  Surface surface;
  surface.shape = SurfaceShape::height_map;
  for (const Pose& pose : poses_of({}, kPillars)) {
    const double height = std::sin(pose.position_mm.x / 9) - pose.position_mm.y / 7;
    surface.heights_mm.push_back(static_cast<float>(height));
  }
  return surface;
}

TEST(Surface, PosesAreRightHandedUnitVectors) {
  for (const Surface& surface :
       {Surface(), shaped(SurfaceShape::cylinder, 12, 33), shaped(SurfaceShape::cylinder, -20, -70),
        shaped(SurfaceShape::sphere, 15), shaped(SurfaceShape::sphere, -40), wavy()}) {
    for (const Pose& pose : poses_of(surface, kPillars)) {
      EXPECT_NEAR(dot(pose.tangent_x, pose.tangent_x), 1, 1e-14);
      EXPECT_NEAR(dot(pose.tangent_y, pose.tangent_y), 1, 1e-14);
      expect_equal(cross(pose.tangent_x, pose.tangent_y), pose.normal, 1e-14);
      EXPECT_GT(pose.normal.z, -1);
    }
  }
}

TEST(Surface, PillarsOfAPlaneLieInRowsFromTheTopLeft) {
  const std::vector<Pose> poses = poses_of({}, kPillars);
  expect_equal(poses.front().position_mm, {-14.5 * 1.25, 8 * 1.25, 0}, 1e-12);
  expect_equal(poses.back().position_mm, {14.5 * 1.25, -8 * 1.25, 0}, 1e-12);
  expect_equal(poses.front().normal, {0, 0, 1}, 0);
}

TEST(Surface, PointsLieOnTheirSurface) {
  for (const double radius : {12.0, -25.0}) {
    const Vector3 middle = {0, 0, -radius};
    for (const Pose& pose : poses_of(shaped(SurfaceShape::sphere, radius), kPillars)) {
      expect_equal(pose.position_mm, middle + radius * pose.normal, 1e-12);
    }
    const double axis = 25 * std::numbers::pi / 180;
    const Vector3 along = {std::cos(axis), std::sin(axis), 0};
    for (const Pose& pose : poses_of(shaped(SurfaceShape::cylinder, radius, 25), kPillars)) {
      const Vector3 from_axis = pose.position_mm - middle - dot(pose.position_mm, along) * along;
      expect_equal(from_axis, radius * pose.normal, 1e-12);
    }
  }
}

/// The tangents are the derivatives of the position: on a cylinder everywhere, on a sphere along
/// the circle through the middle.
TEST(Surface, TangentsFollowTheSheet) {
  const double step = 1e-4;
  const Surface cylinder = shaped(SurfaceShape::cylinder, 9, 60);
  const Surface sphere = shaped(SurfaceShape::sphere, 30);
  const auto slope = [&](const Surface& on, double x, double y, double dx, double dy) {
    const Vector3 after = pose_at(on, x + step * dx, y + step * dy).position_mm;
    const Vector3 before = pose_at(on, x - step * dx, y - step * dy).position_mm;
    return 1 / (2 * step) * (after - before);
  };
  const Pose pose = pose_at(cylinder, 7, -3);
  expect_equal(slope(cylinder, 7, -3, 1, 0), pose.tangent_x, 1e-8);
  expect_equal(slope(cylinder, 7, -3, 0, 1), pose.tangent_y, 1e-8);
  const Pose on_sphere = pose_at(sphere, 6, 8);
  expect_equal(slope(sphere, 6, 8, 0.6, 0.8), 0.6 * on_sphere.tangent_x + 0.8 * on_sphere.tangent_y,
               1e-8);
}

/// The height map of a shallow cylinder has its poses.
TEST(Surface, AHeightMapHasTheSlopesOfItsHeights) {
  const double radius = 400;
  Surface map;
  map.shape = SurfaceShape::height_map;
  for (const Pose& pose : poses_of({}, kPillars)) {
    map.heights_mm.push_back(
        static_cast<float>(std::sqrt(radius * radius - pose.position_mm.x * pose.position_mm.x)));
  }
  for (const Pose& pose : poses_of(map, kPillars)) {
    const double sine = pose.position_mm.x / radius;
    expect_equal(pose.normal, {sine, 0, std::sqrt(1 - sine * sine)}, 2e-3);
  }
}

TEST(Surface, RefusesWhatDoesNotFit) {
  const auto refuses = [](const Surface& surface, const char* words) {
    try {
      check(surface, kPillars, "test");
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  refuses(shaped(SurfaceShape::cylinder, 0), "radius_mm");
  refuses(shaped(SurfaceShape::sphere, NAN), "radius_mm");
  refuses(shaped(SurfaceShape::cylinder, 60, 1e3), "axis_deg");
  refuses(shaped(SurfaceShape::cylinder, 5), "at least 5.968");
  refuses(shaped(SurfaceShape::sphere, -13), "half a sphere");
  refuses(shaped(SurfaceShape::height_map, 0), "no heights");
  Surface map = wavy();
  map.heights_mm[3] = NAN;
  refuses(map, "height");
  check(shaped(SurfaceShape::cylinder, 37.5 / (2 * std::numbers::pi)), kPillars, "test");
}

}  // namespace
}  // namespace pillarfield
