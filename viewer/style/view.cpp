#include "viewer/style/view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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
  const Pose target = pose_at(surface, view.target_mm);
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
  camera.eye = target.position_mm - view.distance_mm * camera.forward;
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

namespace {

const Surface& flat() {
  static const Surface plane;
  return plane;
}

/// The surface that applies to a view.
const Surface& shown(const View& view, const Surface& surface) {
  return std::holds_alternative<TopView>(view) ? flat() : surface;
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
  const Camera camera = camera_of(view, flat(), viewport);
  return camera.perspective ? camera.pixels / camera.distance_mm : camera.pixels;
}

namespace {

constexpr double kMargin = 0.04;  ///< fraction of the viewport at each side

// Limits: from one pillar filling the window to any realistic skin in view.
constexpr double kMostPixelsPerMm = 1000;
constexpr double kLeastPixelsPerMm = 0.005;
constexpr double kNearestMm = 1;
constexpr double kFarthestMm = 2e5;
constexpr double kFarthestAsideMm = 5e4;
constexpr double kLowestElevation = 0.05;
constexpr double kRadiansPerPixel = 0.008;

double limited_scale(double pixels_per_mm) {
  return std::clamp(pixels_per_mm, kLeastPixelsPerMm, kMostPixelsPerMm);
}

double limited_distance(double distance_mm) {
  return std::clamp(distance_mm, kNearestMm, kFarthestMm);
}

Vec2 limited_place(Vec2 place) {
  return {std::clamp(place.x, -kFarthestAsideMm, kFarthestAsideMm),
          std::clamp(place.y, -kFarthestAsideMm, kFarthestAsideMm)};
}

Vec2& centre_of(View& view) {
  if (auto* top = std::get_if<TopView>(&view)) return top->centre_mm;
  return std::get<OrbitView>(view).target_mm;
}

/// Shift of the sheet, mm, for a mouse movement of `pixels`.
Vec2 sheet_shift(const View& view, const Viewport& viewport, Vec2 pixels) {
  const double scale = pixels_per_mm(view, viewport);
  const Vec2 way{pixels.x / scale, -pixels.y / scale};
  const auto* orbit = std::get_if<OrbitView>(&view);
  if (orbit == nullptr) return way;
  // At grazing views a pixel spans a long distance; bound it, or the sheet would jump.
  const double away = way.y / std::max(std::sin(orbit->elevation), 0.2);
  const double sine = std::sin(orbit->azimuth);
  const double cosine = std::cos(orbit->azimuth);
  return {cosine * way.x - sine * away, sine * way.x + cosine * away};
}

/// Distance at which a point lies within the viewport less its margin.
double distance_to_fit(const Camera& camera, const Viewport& viewport, Vec3 point) {
  const Vec3 seen = in_camera(camera, point);
  const double half_width = (0.5 - kMargin) * viewport.width;
  const double half_height = (0.5 - kMargin) * viewport.height;
  const double needed = camera.pixels * std::max(std::abs(seen.x) / half_width,  //
                                                 std::abs(seen.y) / half_height);
  return camera.distance_mm + needed - seen.z;
}

}  // namespace

TopView fit_top(const SkinSize& skin, const Viewport& viewport) {
  const double share = 1 - 2 * kMargin;
  return {{0, 0},
          limited_scale(std::min(share * viewport.width / skin.width_mm,
                                 share * viewport.height / skin.height_mm))};
}

OrbitView fit_orbit(const SkinSize& skin, const Surface& surface, const Viewport& viewport,
                    OrbitView view) {
  constexpr int kSteps = 32;
  view.target_mm = {};
  const Camera camera = camera_of(view, surface, viewport);
  double distance = 0;
  for (int row = -kSteps; row <= kSteps; ++row) {
    for (int col = -kSteps; col <= kSteps; ++col) {
      const Vec2 point{skin.width_mm / 2 * col / kSteps, skin.height_mm / 2 * row / kSteps};
      const Vec3 place = pose_at(surface, point).position_mm;
      distance = std::max(distance, distance_to_fit(camera, viewport, place));
    }
  }
  view.distance_mm = limited_distance(distance);
  return view;
}

void pan(View& view, const Viewport& viewport, Vec2 pixels) {
  const Vec2 way = sheet_shift(view, viewport, pixels);
  Vec2& middle = centre_of(view);
  middle = limited_place({middle.x - way.x, middle.y - way.y});
}

void orbit(View& view, Vec2 pixels) {
  auto* orbit = std::get_if<OrbitView>(&view);
  if (orbit == nullptr) return;
  // The sheet follows the mouse, so the eye moves the other way.
  orbit->azimuth =
      std::remainder(orbit->azimuth - kRadiansPerPixel * pixels.x, 2 * std::numbers::pi);
  orbit->elevation = std::clamp(orbit->elevation + kRadiansPerPixel * pixels.y, kLowestElevation,
                                std::numbers::pi / 2);
}

void zoom(View& view, const Viewport& viewport, Vec2 pixel, double factor) {
  if (auto* orbit = std::get_if<OrbitView>(&view)) {
    orbit->distance_mm = limited_distance(orbit->distance_mm / factor);
    return;
  }
  auto& top = std::get<TopView>(view);
  const Vec2 offset{pixel.x - viewport.x - viewport.width / 2,
                    pixel.y - viewport.y - viewport.height / 2};
  const double before = top.pixels_per_mm;
  top.pixels_per_mm = limited_scale(before * factor);
  const double moved = 1 / before - 1 / top.pixels_per_mm;
  top.centre_mm =
      limited_place({top.centre_mm.x + offset.x * moved, top.centre_mm.y - offset.y * moved});
}

void keep_on_skin(View& view, const SkinSize& skin) {
  Vec2& middle = centre_of(view);
  middle = {std::clamp(middle.x, -skin.width_mm / 2, skin.width_mm / 2),
            std::clamp(middle.y, -skin.height_mm / 2, skin.height_mm / 2)};
}

}  // namespace pillarfield::viewer
