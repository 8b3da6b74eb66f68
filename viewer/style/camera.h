#pragma once

#include "viewer/style/surface.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// A view as an eye in space, in double precision. What lies `right` and `up` of the eye's axis by
/// a millimetre at depth d is `pixels` / d away from the viewport's middle in perspective, else
/// `pixels`.
struct Camera {
  Vec3 eye;
  Vec3 right, up, forward;  ///< unit vectors, orthogonal
  double pixels = 1;
  bool perspective = false;
  double distance_mm = 0;  ///< from the eye to what it looks at
};
[[nodiscard]] Camera camera_of(const View& view, const Surface& surface, const Viewport& viewport);

/// A point as the camera sees it, mm.
[[nodiscard]] Vec3 seen_by(const Camera& camera, Vec3 point);  ///< x right, y up, z depth

/// The points that appear at `offset` pixels (x right, y down) from the viewport's middle.
[[nodiscard]] Ray ray_through(const Camera& camera, Vec2 offset);

/// Depths between which a box, grown by kArrowRoomMm, lies before the eye.
struct DepthRange {
  double near_mm, far_mm;
};
[[nodiscard]] DepthRange depths_of(const Camera& camera, const Box& box);

}  // namespace pillarfield::viewer
