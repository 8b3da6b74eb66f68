#pragma once

#include <array>
#include <optional>

#include "pillarfield/surface.h"
#include "viewer/style/view.h"

/// Intersections and extents of surfaces.
namespace pillarfield::viewer {

/// A skin's surface as the viewer draws it: a height map as a plane.
[[nodiscard]] Surface drawn_surface(const std::optional<pillarfield::Surface>& surface);

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
