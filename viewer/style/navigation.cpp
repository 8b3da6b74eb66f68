#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/style/camera.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {
namespace {

constexpr double kAir = 0.04;  ///< of the viewport, at each side

// Limits: from a pillar that fills the window to a skin larger than any that can be made.
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

/// How the sheet moves under a mouse that goes by `pixels`, mm.
Vec2 way_on_sheet(const View& view, const Viewport& viewport, Vec2 pixels) {
  const double scale = pixels_per_mm(view, viewport);
  const Vec2 way{pixels.x / scale, -pixels.y / scale};
  const auto* orbit = std::get_if<OrbitView>(&view);
  if (orbit == nullptr) return way;
  // Seen flat, a pixel's height is a long way; it is bounded, or the sheet would leap.
  const double away = way.y / std::max(std::sin(orbit->elevation), 0.2);
  const double sine = std::sin(orbit->azimuth);
  const double cosine = std::cos(orbit->azimuth);
  return {cosine * way.x - sine * away, sine * way.x + cosine * away};
}

/// The distance from which a point, seen from `camera`, is within the viewport and its air.
double distance_to_fit(const Camera& camera, const Viewport& viewport, Vec3 point) {
  const Vec3 seen = seen_by(camera, point);
  const double half_width = (0.5 - kAir) * viewport.width;
  const double half_height = (0.5 - kAir) * viewport.height;
  const double needed = camera.pixels * std::max(std::abs(seen.x) / half_width,  //
                                                 std::abs(seen.y) / half_height);
  return camera.distance_mm + needed - seen.z;
}

}  // namespace

TopView fit_top(const SkinSize& skin, const Viewport& viewport) {
  const double share = 1 - 2 * kAir;
  return {{0, 0},
          limited_scale(std::min(share * viewport.width / skin.width_mm,
                                 share * viewport.height / skin.height_mm))};
}

OrbitView fit_orbit(const SkinSize& skin, const Surface& surface, const Viewport& viewport) {
  constexpr int kSteps = 32;
  OrbitView view;
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
  const Vec2 way = way_on_sheet(view, viewport, pixels);
  Vec2& middle = middle_of(view);
  middle = limited_place({middle.x - way.x, middle.y - way.y});
}

void orbit(View& view, Vec2 pixels) {
  auto* orbit = std::get_if<OrbitView>(&view);
  if (orbit == nullptr) return;
  // The sheet follows the mouse, so the eye goes the other way.
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
