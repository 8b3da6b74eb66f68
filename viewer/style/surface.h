#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "pillarfield/surface.h"

/// Intersections and extents of the surface under the skin, whose poses are the library's: a plane,
/// cylinder or sphere. shaders/surface.glsl holds the GLSL version.
namespace pillarfield::viewer {

struct Vec2 {
  double x = 0, y = 0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};
using Vec3 = Vector3;

[[nodiscard]] constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
[[nodiscard]] constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
[[nodiscard]] constexpr Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
[[nodiscard]] constexpr double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
[[nodiscard]] inline double length(Vec3 a) { return std::sqrt(dot(a, a)); }

/// Size of the flat sheet; its coordinates are x right, y up, mm from the middle.
struct SkinSize {
  double width_mm = 0, height_mm = 0;
};

/// The same surface, but for heights, which are not drawn.
[[nodiscard]] inline bool operator==(const Surface& a, const Surface& b) {
  return a.shape == b.shape && a.radius_mm == b.radius_mm && a.axis_deg == b.axis_deg;
}

/// Pose of a point of the sheet.
[[nodiscard]] inline Pose pose_at(const Surface& surface, Vec2 point_mm) {
  return pillarfield::pose_at(surface, point_mm.x, point_mm.y);
}

/// The surface as the shaders take it (shaders/surface.glsl).
[[nodiscard]] std::array<float, 4> shader_surface(const Surface& surface);

/// The points origin + t * direction, t > 0.
struct Ray {
  Vec3 origin, direction;
};

/// First intersection of a ray with the skin, from either side; none without one. On a skin that
/// winds around a cylinder more than once, in the middle turn.
[[nodiscard]] std::optional<Vec2> first_hit(const Ray& ray, const Surface& surface,
                                            const SkinSize& skin);

/// Bounding box of the skin on its surface, mm.
struct Box {
  Vec3 low, high;
};
[[nodiscard]] Box box_about(const SkinSize& skin, const Surface& surface);

}  // namespace pillarfield::viewer
