#include "viewer/style/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace pillarfield::viewer {
namespace {

bool is_plane(const Surface& surface) { return surface.shape == SurfaceShape::plane; }
bool is_sphere(const Surface& surface) { return surface.shape == SurfaceShape::sphere; }

/// Unit vector of the bent direction of a cylinder.
Vec2 bent_direction(const Surface& surface) {
  const double angle = (surface.axis_deg - 90) * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle)};
}

bool is_on(const SkinSize& skin, Vec2 point) {
  return std::abs(point.x) <= skin.width_mm / 2 && std::abs(point.y) <= skin.height_mm / 2;
}

std::optional<Vec2> hit_on_plane(const Ray& ray, const SkinSize& skin) {
  const double way = -ray.origin.z / ray.direction.z;
  if (!(way > 0) || !std::isfinite(way)) return std::nullopt;
  const Vec3 place = ray.origin + way * ray.direction;
  const Vec2 point{place.x, place.y};
  return is_on(skin, point) ? std::optional(point) : std::nullopt;
}

/// Ray parameters of the intersections with a circle or sphere of `radius` about the origin,
/// ascending; NaN for none.
std::array<double, 2> hits(Vec3 origin, Vec3 direction, double radius) {
  const double speed = length(direction);
  const double to_foot = -dot(origin, direction) / speed;
  const Vec3 foot = origin + (to_foot / speed) * direction;
  const double from_middle = length(foot);
  const double half_chord = std::sqrt((radius - from_middle) * (radius + from_middle));
  return {(to_foot - half_chord) / speed, (to_foot + half_chord) / speed};
}

/// The point of the sheet that lies at a place of the surface.
Vec2 on_sheet(const Surface& surface, Vec3 place) {
  Vec2 along = bent_direction(surface);
  if (is_sphere(surface)) {
    const double away = std::hypot(place.x, place.y);
    if (away == 0) return {};
    along = {place.x / away, place.y / away};
  }
  const double radius = surface.radius_mm;
  const double arc = radius * std::atan2((along.x * place.x + along.y * place.y) / radius,
                                         (place.z + radius) / radius);
  const double across = is_sphere(surface) ? 0 : along.x * place.y - along.y * place.x;
  return {arc * along.x - across * along.y, arc * along.y + across * along.x};
}

std::optional<Vec2> hit_on_curve(const Ray& ray, const Surface& surface, const SkinSize& skin) {
  const Vec2 along = bent_direction(surface);
  // A cylinder is hit in the plane across its axis.
  const auto flat = [&](Vec3 vector) {
    return is_sphere(surface) ? vector : Vec3{along.x * vector.x + along.y * vector.y, 0, vector.z};
  };
  const Vec3 from_middle = flat(ray.origin) + Vec3{0, 0, surface.radius_mm};
  for (const double way : hits(from_middle, flat(ray.direction), std::abs(surface.radius_mm))) {
    if (!(way > 0)) continue;
    const Vec3 place = ray.origin + way * ray.direction;
    const Vec2 point = on_sheet(surface, place);
    if (is_on(skin, point)) return point;
  }
  return std::nullopt;
}

/// Half sizes of the skin seen from above, and its depth.
Vec3 extent_of(const SkinSize& skin, const Surface& surface) {
  const double width = skin.width_mm / 2;
  const double height = skin.height_mm / 2;
  const double radius = std::abs(surface.radius_mm);
  const auto depth = [&](double arc) {
    return radius * (1 - std::cos(std::min(arc / radius, std::numbers::pi)));
  };
  if (is_sphere(surface)) {
    return {std::min(width, radius), std::min(height, radius), depth(std::hypot(width, height))};
  }
  const Vec2 along = bent_direction(surface);
  const double x = std::abs(along.x);
  const double y = std::abs(along.y);
  const double arc = x * width + y * height;
  const double away = radius * std::sin(std::min(arc / radius, std::numbers::pi / 2));
  const double across = y * width + x * height;
  return {x * away + y * across, y * away + x * across, depth(arc)};
}

}  // namespace

std::array<float, 4> shader_surface(const Surface& surface) {
  if (is_plane(surface)) return {};
  const Vec2 along = bent_direction(surface);
  return {static_cast<float>(along.x), static_cast<float>(along.y),
          static_cast<float>(surface.radius_mm), static_cast<float>(surface.shape)};
}

std::optional<Vec2> first_hit(const Ray& ray, const Surface& surface, const SkinSize& skin) {
  return is_plane(surface) ? hit_on_plane(ray, skin) : hit_on_curve(ray, surface, skin);
}

Box box_about(const SkinSize& skin, const Surface& surface) {
  if (is_plane(surface)) {
    return {{-skin.width_mm / 2, -skin.height_mm / 2, 0},
            {skin.width_mm / 2, skin.height_mm / 2, 0}};
  }
  const Vec3 extent = extent_of(skin, surface);
  const bool convex = surface.radius_mm > 0;
  return {{-extent.x, -extent.y, convex ? -extent.z : 0},
          {extent.x, extent.y, convex ? 0 : extent.z}};
}

}  // namespace pillarfield::viewer
