#include "viewer/style/view.h"

#include "viewer/style/camera.h"

namespace pillarfield::viewer {
namespace {

constexpr Surface kFlat;

/// The surface that applies to a view.
const Surface& shown(const View& view, const Surface& surface) {
  return std::holds_alternative<TopView>(view) ? kFlat : surface;
}

Vec2 middle_of(const Viewport& viewport) {
  return {viewport.x + viewport.width / 2, viewport.y + viewport.height / 2};
}

/// A linear function of a point in space.
struct Row {
  Vec3 slope;
  double constant;
};

/// factor * ((point - eye) . axis) + constant
Row row_along(Vec3 axis, Vec3 eye, double factor, double constant = 0) {
  return {factor * axis, constant - factor * dot(axis, eye)};
}

Matrix matrix_of(const std::array<Row, 4>& rows) {
  Matrix matrix{};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [slope, constant] = rows.at(i);
    matrix.at(i) = static_cast<float>(slope.x);
    matrix.at(4 + i) = static_cast<float>(slope.y);
    matrix.at(8 + i) = static_cast<float>(slope.z);
    matrix.at(12 + i) = static_cast<float>(constant);
  }
  return matrix;
}

}  // namespace

Matrix clip_from_world(const View& view, const Surface& surface, const SkinSize& skin,
                       const Viewport& viewport) {
  const Surface& laid_on = shown(view, surface);
  const Camera camera = camera_of(view, laid_on, viewport);
  const auto [near, far] = depths_of(camera, box_about(skin, laid_on));
  // Depth after the division by w, the distance along `forward`: 0 at near and 1 at far.
  const double slope = (camera.perspective ? far : 1) / (far - near);
  const Row right = row_along(camera.right, camera.eye, 2 * camera.pixels / viewport.width);
  const Row down = row_along(camera.up, camera.eye, -2 * camera.pixels / viewport.height);
  const Row depth = row_along(camera.forward, camera.eye, slope, -slope * near);
  const Row w = camera.perspective ? row_along(camera.forward, camera.eye, 1) : Row{{}, 1};
  return matrix_of({right, down, depth, w});
}

std::optional<Vec2> project(const View& view, const Surface& surface, const SkinSize&,
                            const Viewport& viewport, Vec3 point_mm) {
  const Camera camera = camera_of(view, shown(view, surface), viewport);
  const Vec3 seen = in_camera(camera, point_mm);
  if (camera.perspective && !(seen.z > 0)) return std::nullopt;
  const double scale = camera.perspective ? camera.pixels / seen.z : camera.pixels;
  const Vec2 middle = middle_of(viewport);
  return Vec2{middle.x + scale * seen.x, middle.y - scale * seen.y};
}

std::optional<Vec2> pick(const View& view, const Surface& surface, const SkinSize& skin,
                         const Viewport& viewport, Vec2 pixel) {
  const Surface& laid_on = shown(view, surface);
  const Camera camera = camera_of(view, laid_on, viewport);
  const Vec2 middle = middle_of(viewport);
  return first_hit(ray_through(camera, {pixel.x - middle.x, pixel.y - middle.y}), laid_on, skin);
}

double pixels_per_mm(const View& view, const Viewport& viewport) {
  const Camera camera = camera_of(view, kFlat, viewport);
  return camera.perspective ? camera.pixels / camera.distance_mm : camera.pixels;
}

}  // namespace pillarfield::viewer
