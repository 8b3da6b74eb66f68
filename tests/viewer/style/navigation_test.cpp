// Fitting views and navigating by mouse.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "random_view.h"

namespace pillarfield::viewer {
namespace {

struct Extent {
  double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
};

/// Extent of the skin as a fraction of the viewport, from its middle.
Extent extent_of(const Situation& situation) {
  const auto& [view, surface, skin, viewport] = situation;
  const Surface shown = std::holds_alternative<TopView>(view) ? Surface{} : surface;
  Extent extent;
  for (int row = -20; row <= 20; ++row) {
    for (int col = -20; col <= 20; ++col) {
      const Vec2 at{skin.width_mm / 40 * col, skin.height_mm / 40 * row};
      const Vec2 pixel =
          project(view, surface, skin, viewport, frame_at(shown, at).position).value();
      const double x = (pixel.x - viewport.x) / viewport.width - 0.5;
      const double y = (pixel.y - viewport.y) / viewport.height - 0.5;
      extent.left = std::min(extent.left, x);
      extent.right = std::max(extent.right, x);
      extent.top = std::min(extent.top, y);
      extent.bottom = std::max(extent.bottom, y);
    }
  }
  return extent;
}

double largest_of(const Extent& extent) {
  return std::max({-extent.left, extent.right, -extent.top, extent.bottom});
}

TEST(Fit, TopViewHasTheWholeSkinAndFourPercentMargin) {
  std::mt19937 random(1);
  for (int i = 0; i < 200; ++i) {
    Situation situation = random_situation(random);
    situation.view = fit_top(situation.skin, situation.viewport);
    const Extent extent = extent_of(situation);
    EXPECT_NEAR(largest_of(extent), 0.46, 1e-9);
    EXPECT_NEAR(extent.left, -extent.right, 1e-9);
    EXPECT_NEAR(extent.top, -extent.bottom, 1e-9);
  }
}

TEST(Fit, OrbitViewHasTheWholeSkinAndFillsTheViewport) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    Situation situation = random_situation(random);
    situation.view = fit_orbit(situation.skin, situation.surface, situation.viewport);
    EXPECT_NEAR(largest_of(extent_of(situation)), 0.46, 0.005);
  }
}

TEST(Fit, KeepsTheLimits) {
  const Viewport viewport{0, 0, 800, 600};
  EXPECT_LE(fit_top({0, 0}, viewport).pixels_per_mm, 1000);
  EXPECT_GT(fit_top({1e9, 1e9}, viewport).pixels_per_mm, 0);
  EXPECT_GT(fit_orbit({0, 0}, {}, viewport).distance_mm, 0);
}

TEST(Pan, InATopViewTheSheetFollowsTheMouse) {
  std::mt19937 random(3);
  for (int i = 0; i < 300; ++i) {
    Situation situation = random_situation(random);
    auto& [view, surface, skin, viewport] = situation;
    view = TopView{random_place_on(skin, random), random_between(random, 0.1, 50)};
    const Vec3 point{random_between(random, -50, 50), random_between(random, -50, 50), 0};
    const Vec2 before = *project(view, surface, skin, viewport, point);
    const Vec2 way{random_between(random, -90, 90), random_between(random, -90, 90)};
    pan(view, viewport, way);
    const Vec2 after = *project(view, surface, skin, viewport, point);
    EXPECT_NEAR(after.x, before.x + way.x, 1e-8);
    EXPECT_NEAR(after.y, before.y + way.y, 1e-8);
  }
}

TEST(Pan, InAnOrbitViewTheMiddleFollowsTheMouse) {
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    Situation situation = random_situation(random);
    auto& [view, surface, skin, viewport] = situation;
    OrbitView orbit;
    orbit.azimuth = random_between(random, -3, 3);
    orbit.elevation = random_between(random, 0.3, 1.57);
    orbit.target_mm = random_place_on(skin, random);
    view = orbit;
    // On a curved skin the eye turns along; the path of its target on the sheet is unchanged.
    const Vec3 point{orbit.target_mm.x, orbit.target_mm.y, 0};
    const Vec2 before = *project(view, {}, skin, viewport, point);
    const Vec2 way{random_between(random, -0.1, 0.1), random_between(random, -0.1, 0.1)};
    pan(view, viewport, way);
    const Vec2 after = *project(view, {}, skin, viewport, point);
    EXPECT_NEAR(after.x, before.x + way.x, 1e-3);
    EXPECT_NEAR(after.y, before.y + way.y, 1e-3);
  }
}

TEST(Pan, StaysWithinLimits) {
  const Viewport viewport{0, 0, 800, 600};
  for (View view : {View(TopView{}), View(OrbitView{})}) {
    for (int i = 0; i < 1000; ++i) pan(view, viewport, {-1e6, 1e6});
    const Vec2 middle = std::holds_alternative<TopView>(view) ? std::get<TopView>(view).centre_mm
                                                              : std::get<OrbitView>(view).target_mm;
    EXPECT_LE(std::abs(middle.x), 1e5);
    EXPECT_LE(std::abs(middle.y), 1e5);
    keep_on_skin(view, {100, 60});
    const Vec2 kept = std::holds_alternative<TopView>(view) ? std::get<TopView>(view).centre_mm
                                                            : std::get<OrbitView>(view).target_mm;
    EXPECT_EQ(std::abs(kept.x), 50);
    EXPECT_EQ(std::abs(kept.y), 30);
  }
}

TEST(KeepOnSkin, ChangesNothingThere) {
  View view = TopView{{10, -20}, 3};
  keep_on_skin(view, {100, 60});
  EXPECT_EQ(std::get<TopView>(view).centre_mm.x, 10);
  EXPECT_EQ(std::get<TopView>(view).centre_mm.y, -20);
}

TEST(Orbit, TheNearSideFollowsTheMouse) {
  const Viewport viewport{0, 0, 800, 600};
  const SkinSize skin{100, 100};
  OrbitView start;
  start.azimuth = 0;
  const Vec3 near_side{0, -40, 0};
  const Vec2 before = *project(View(start), {}, skin, viewport, near_side);
  View right = start;
  orbit(right, {10, 0});
  EXPECT_GT(project(right, {}, skin, viewport, near_side)->x, before.x + 2);
  View down = start;
  orbit(down, {0, 10});
  EXPECT_GT(project(down, {}, skin, viewport, near_side)->y, before.y + 2);
}

TEST(Orbit, GoesAroundAndStaysAboveTheSheet) {
  View view = OrbitView{};
  for (int i = 0; i < 2000; ++i) {
    orbit(view, {37, i < 1000 ? 5.0 : -5.0});
    const auto& orbited = std::get<OrbitView>(view);
    EXPECT_LE(std::abs(orbited.azimuth), std::numbers::pi);
    EXPECT_GT(orbited.elevation, 0);
    EXPECT_LE(orbited.elevation, std::numbers::pi / 2);
  }
  EXPECT_LT(std::get<OrbitView>(view).elevation, 0.1) << "nearly flat";
}

TEST(Orbit, LeavesATopViewAlone) {
  View view = TopView{{1, 2}, 3};
  orbit(view, {100, 100});
  EXPECT_EQ(std::get<TopView>(view).centre_mm.x, 1);
  EXPECT_EQ(std::get<TopView>(view).pixels_per_mm, 3);
}

TEST(Zoom, KeepsThePointUnderTheMouseOfATopView) {
  std::mt19937 random(5);
  for (int i = 0; i < 300; ++i) {
    Situation situation = random_situation(random);
    auto& [view, surface, skin, viewport] = situation;
    view = fit_top(skin, viewport);
    const Vec3 point{random_between(random, -0.4, 0.4) * skin.width_mm,
                     random_between(random, -0.4, 0.4) * skin.height_mm, 0};
    const Vec2 pixel = *project(view, surface, skin, viewport, point);
    const double factor = random_between(random, 0.2, 8);
    const double before = pixels_per_mm(view, viewport);
    zoom(view, viewport, pixel, factor);
    EXPECT_NEAR(pixels_per_mm(view, viewport) / before, factor, 1e-12);
    const Vec2 after = *project(view, surface, skin, viewport, point);
    EXPECT_NEAR(after.x, pixel.x, 1e-8);
    EXPECT_NEAR(after.y, pixel.y, 1e-8);
  }
}

TEST(Zoom, BringsAnOrbitViewNearerByTheFactor) {
  const Viewport viewport{0, 0, 800, 600};
  View view = OrbitView{};
  const double before = pixels_per_mm(view, viewport);
  zoom(view, viewport, {3, 4}, 1.25);
  EXPECT_NEAR(pixels_per_mm(view, viewport), 1.25 * before, 1e-12);
}

TEST(Zoom, StaysWithinLimitsAndComesBack) {
  const Viewport viewport{0, 0, 800, 600};
  for (View view : {View(TopView{}), View(OrbitView{})}) {
    for (const double factor : {10.0, 0.1}) {
      for (int i = 0; i < 100; ++i) zoom(view, viewport, {799, 1}, factor);
      const double scale = pixels_per_mm(view, viewport);
      EXPECT_TRUE(std::isfinite(scale));
      EXPECT_GT(scale, factor > 1 ? 100 : 1e-4);
      EXPECT_LT(scale, factor > 1 ? 2000 : 0.1);
    }
  }
}

}  // namespace
}  // namespace pillarfield::viewer
