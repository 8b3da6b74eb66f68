#include "viewer/style/camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viewer/style/view.h"

namespace pillarfield::viewer {
namespace {

Camera camera_above(const TopView& view) {
  Camera camera;
  camera.eye = {view.centre_mm.x, view.centre_mm.y, 0};
  camera.right = {1, 0, 0};
  camera.up = {0, 1, 0};
  camera.forward = {0, 0, -1};
  camera.pixels = view.pixels_per_mm;
  return camera;
}

Camera camera_around(const OrbitView& view, const Surface& surface, const Viewport& viewport) {
  const SurfaceFrame target = frame_at(surface, view.target_mm);
  const double sine = std::sin(view.elevation);
  const double cosine = std::cos(view.elevation);
  /// Along the sheet, away from the eye; defined also for a view from straight above.
  const Vec3 away =
      std::cos(view.azimuth) * target.tangent_y - std::sin(view.azimuth) * target.tangent_x;
  Camera camera;
  camera.right =
      std::cos(view.azimuth) * target.tangent_x + std::sin(view.azimuth) * target.tangent_y;
  camera.up = sine * away + cosine * target.normal;
  camera.forward = cosine * away - sine * target.normal;
  camera.eye = target.position - view.distance_mm * camera.forward;
  camera.pixels = viewport.height / (2 * std::tan(view.field_of_view / 2));
  camera.perspective = true;
  camera.distance_mm = view.distance_mm;
  return camera;
}

}  // namespace

Camera camera_of(const View& view, const Surface& surface, const Viewport& viewport) {
  if (const auto* top = std::get_if<TopView>(&view)) return camera_above(*top);
  return camera_around(std::get<OrbitView>(view), surface, viewport);
}

Vec3 in_camera(const Camera& camera, Vec3 point) {
  const Vec3 offset = point - camera.eye;
  return {dot(camera.right, offset), dot(camera.up, offset), dot(camera.forward, offset)};
}

Ray ray_through(const Camera& camera, Vec2 offset) {
  const Vec3 aside = offset.x / camera.pixels * camera.right - offset.y / camera.pixels * camera.up;
  if (camera.perspective) return {camera.eye, camera.forward + aside};
  // Start above the sheet: the eye of a top view lies on it.
  return {camera.eye + aside - camera.forward, camera.forward};
}

DepthRange depths_of(const Camera& camera, const Box& box) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  DepthRange range{kInfinity, -kInfinity};
  for (const double x : {box.low.x - kArrowMarginMm, box.high.x + kArrowMarginMm}) {
    for (const double y : {box.low.y - kArrowMarginMm, box.high.y + kArrowMarginMm}) {
      for (const double z : {box.low.z - kArrowMarginMm, box.high.z + kArrowMarginMm}) {
        const double depth = in_camera(camera, {x, y, z}).z;
        range.near_mm = std::min(range.near_mm, depth);
        range.far_mm = std::max(range.far_mm, depth);
      }
    }
  }
  if (!camera.perspective) return range;
  // With the eye among the arrows, clip the nearest ones to keep depth precision.
  range.near_mm = std::max(range.near_mm, camera.distance_mm / 100);
  range.far_mm = std::max(range.far_mm, 1.01 * range.near_mm);
  return range;
}

}  // namespace pillarfield::viewer
