#pragma once

#include <optional>

#include "viewer/style/view.h"

/// What a view needs to know of a surface, beside frame_at().
namespace pillarfield::viewer {

/// The points origin + t * direction, t > 0.
struct Ray {
  Vec3 origin, direction;
};

/// Where a ray first meets the skin on its surface, from either side; none where it does not. A
/// skin that goes around a cylinder more than once is met in its middle turn.
[[nodiscard]] std::optional<Vec2> first_hit(const Ray& ray, const Surface& surface,
                                            const SkinSize& skin);

/// A box about the skin on its surface, mm.
struct Box {
  Vec3 low, high;
};
[[nodiscard]] Box box_about(const SkinSize& skin, const Surface& surface);

}  // namespace pillarfield::viewer
