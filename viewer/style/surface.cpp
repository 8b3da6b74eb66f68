#include "viewer/style/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "viewer/style/vectors.h"

namespace pillarfield::viewer {
namespace {

bool is_curved(const Surface& surface) {
  return surface.kind == SurfaceKind::cylinder && surface.radius_mm >= kLeastRadiusMm;
}

bool is_on(const SkinSize& skin, Vec2 point) {
  return std::abs(point.x) <= skin.width_mm / 2 && std::abs(point.y) <= skin.height_mm / 2;
}

SurfaceFrame on_plane(Vec2 point) {
  return {{point.x, point.y, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

SurfaceFrame on_cylinder(double radius, Vec2 point) {
  const double angle = point.x / radius;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double half = std::sin(angle / 2);
  // cos(angle) - 1 would cancel at a large radius.
  return {{radius * sine, point.y, -2 * radius * half * half},
          {cosine, 0, -sine},
          {0, 1, 0},
          {sine, 0, cosine}};
}

std::optional<Vec2> hit_on_plane(const Ray& ray, const SkinSize& skin) {
  const double way = -ray.origin.z / ray.direction.z;
  if (!(way > 0) || !std::isfinite(way)) return std::nullopt;
  const Vec3 place = ray.origin + way * ray.direction;
  const Vec2 point{place.x, place.y};
  return is_on(skin, point) ? std::optional(point) : std::nullopt;
}

/// Ray parameters of the intersections with the whole cylinder, ascending; NaN for none.
std::array<double, 2> cylinder_hits(const Ray& ray, double radius) {
  // In the plane normal to the axis, with the axis as origin.
  const double x = ray.origin.x;
  const double z = ray.origin.z + radius;
  const double across = std::hypot(ray.direction.x, ray.direction.z);
  const double dx = ray.direction.x / across;
  const double dz = ray.direction.z / across;
  const double to_foot = -(x * dx + z * dz);
  const double from_axis = x * dz - z * dx;
  const double half_chord = std::sqrt((radius - from_axis) * (radius + from_axis));
  return {(to_foot - half_chord) / across, (to_foot + half_chord) / across};
}

std::optional<Vec2> hit_on_cylinder(const Ray& ray, double radius, const SkinSize& skin) {
  for (const double way : cylinder_hits(ray, radius)) {
    if (!(way > 0)) continue;
    const Vec3 place = ray.origin + way * ray.direction;
    const Vec2 point{radius * std::atan2(place.x, place.z + radius), place.y};
    if (is_on(skin, point)) return point;
  }
  return std::nullopt;
}

}  // namespace

SurfaceFrame frame_at(const Surface& surface, Vec2 point_mm) {
  return is_curved(surface) ? on_cylinder(surface.radius_mm, point_mm) : on_plane(point_mm);
}

std::optional<Vec2> first_hit(const Ray& ray, const Surface& surface, const SkinSize& skin) {
  return is_curved(surface) ? hit_on_cylinder(ray, surface.radius_mm, skin)
                            : hit_on_plane(ray, skin);
}

Box box_about(const SkinSize& skin, const Surface& surface) {
  double half_width = skin.width_mm / 2;
  double depth = 0;
  if (is_curved(surface)) {
    const double angle = std::min(half_width / surface.radius_mm, std::numbers::pi);
    half_width = surface.radius_mm * std::sin(std::min(angle, std::numbers::pi / 2));
    depth = surface.radius_mm * (1 - std::cos(angle));
  }
  return {{-half_width, -skin.height_mm / 2, -depth}, {half_width, skin.height_mm / 2, 0}};
}

}  // namespace pillarfield::viewer
