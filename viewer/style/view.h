#pragma once

#include <array>
#include <optional>
#include <variant>

#include "viewer/style/surface.h"

namespace pillarfield::viewer {

/// Column major: clip = matrix * (x, y, z, 1), in Vulkan's clip space (y down, z 0..1).
using Matrix = std::array<float, 16>;

/// View from above without perspective; y up.
struct TopView {
  Vec2 centre_mm;  ///< sheet point in the middle of the viewport
  double pixels_per_mm = 1;
  friend bool operator==(const TopView&, const TopView&) = default;
};
/// Perspective view of a target on the sheet; angles refer to the surface frame there.
struct OrbitView {
  Vec2 target_mm;
  double azimuth = 0.6;    ///< rad, about the normal; 0: from -y
  double elevation = 0.9;  ///< rad above the sheet, (0, pi/2]
  double distance_mm = 300;
  double field_of_view = 0.6;  ///< rad, vertical
  friend bool operator==(const OrbitView&, const OrbitView&) = default;
};
using View = std::variant<TopView, OrbitView>;

/// A viewport in pixels from the picture's upper left corner.
struct Viewport {
  double x = 0, y = 0, width = 1, height = 1;
};
[[nodiscard]] constexpr bool contains(const Viewport& box, Vec2 pixel) {
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x < box.x + box.width &&
         pixel.y < box.y + box.height;
}

/// The whole skin in the viewport, with a margin of at least 4 % at each side.
[[nodiscard]] TopView fit_top(const SkinSize& skin, const Viewport& viewport);
/// `view` gives the angles.
[[nodiscard]] OrbitView fit_orbit(const SkinSize& skin, const Surface& surface,
                                  const Viewport& viewport, OrbitView view = {});

/// Arrows up to this length lie between the near and the far plane.
inline constexpr double kArrowMarginMm = 60;

/// Projection for the shaders. Depth is 0 at the near plane and 1 at the far one; both enclose the
/// skin and its arrows tightly. Top views ignore the surface.
[[nodiscard]] Matrix clip_from_world(const View& view, const Surface& surface, const SkinSize& skin,
                                     const Viewport& viewport);

/// Pixel of a point in space; none behind the eye.
[[nodiscard]] std::optional<Vec2> project(const View& view, const Surface& surface,
                                          const SkinSize& skin, const Viewport& viewport,
                                          Vec3 point_mm);

/// Point of the sheet under a pixel; none beside the skin. Top views ignore the surface.
[[nodiscard]] std::optional<Vec2> pick(const View& view, const Surface& surface,
                                       const SkinSize& skin, const Viewport& viewport, Vec2 pixel);

/// Navigation by mouse movements of `pixels`, within limits.
void pan(View& view, const Viewport& viewport, Vec2 pixels);  ///< the sheet follows the mouse
void orbit(View& view, Vec2 pixels);                          ///< no effect on top views
/// `factor` above 1 enlarges; in a top view the point under `pixel` is fixed.
void zoom(View& view, const Viewport& viewport, Vec2 pixel, double factor);
/// Clamps the middle of the view to the skin.
void keep_on_skin(View& view, const SkinSize& skin);

/// Pixels per millimetre of the sheet in the middle of the viewport.
[[nodiscard]] double pixels_per_mm(const View& view, const Viewport& viewport);

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
