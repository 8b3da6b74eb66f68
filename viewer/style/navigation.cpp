#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/style/camera.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {
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

Vec2& middle_of(View& view) {
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
      const Vec3 place = frame_at(surface, point).position;
      distance = std::max(distance, distance_to_fit(camera, viewport, place));
    }
  }
  view.distance_mm = limited_distance(distance);
  return view;
}

void pan(View& view, const Viewport& viewport, Vec2 pixels) {
  const Vec2 way = sheet_shift(view, viewport, pixels);
  Vec2& middle = middle_of(view);
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
  Vec2& middle = middle_of(view);
  middle = {std::clamp(middle.x, -skin.width_mm / 2, skin.width_mm / 2),
            std::clamp(middle.y, -skin.height_mm / 2, skin.height_mm / 2)};
}

}  // namespace pillarfield::viewer
