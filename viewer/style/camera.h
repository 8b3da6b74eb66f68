#pragma once

#include "viewer/style/surface.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// A camera in space, in double precision. An offset of 1 mm from its axis at depth d covers
/// `pixels` / d pixels in perspective, else `pixels`.
struct Camera {
  Vec3 eye;
  Vec3 right, up, forward;  ///< unit vectors, orthogonal
  double pixels = 1;
  bool perspective = false;
  double distance_mm = 0;  ///< from the eye to the target
};
[[nodiscard]] Camera camera_of(const View& view, const Surface& surface, const Viewport& viewport);

/// A point in camera coordinates, mm.
[[nodiscard]] Vec3 in_camera(const Camera& camera, Vec3 point);  ///< x right, y up, z depth

/// The ray through the pixel at `offset` (x right, y down) from the viewport's middle.
[[nodiscard]] Ray ray_through(const Camera& camera, Vec2 offset);

/// Range of depths of a box, grown by kArrowMarginMm, before the eye.
struct DepthRange {
  double near_mm, far_mm;
};
[[nodiscard]] DepthRange depths_of(const Camera& camera, const Box& box);

}  // namespace pillarfield::viewer
