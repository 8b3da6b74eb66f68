#include "viewer/style/view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace pillarfield::viewer {
namespace {

/// A view on some skin, as a user may have turned it.
struct Situation {
  View view;
  Surface surface;
  SkinSize skin;
  Viewport viewport;
};

double random_between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec2 random_place_on(const SkinSize& skin, std::mt19937& random, double share = 0.999) {
  const double x = random_between(random, -share, share) * skin.width_mm / 2;
  return {x, random_between(random, -share, share) * skin.height_mm / 2};
}

Situation random_situation(std::mt19937& random) {
  Situation situation;
  auto& [view, surface, skin, viewport] = situation;
  skin = {random_between(random, 20, 1200), random_between(random, 20, 1200)};
  viewport = {random_between(random, 0, 300), random_between(random, 0, 200),
              random_between(random, 200, 2000), random_between(random, 200, 1500)};
  if (random() % 2 == 0) {
    surface.shape = SurfaceShape::cylinder;
    surface.radius_mm = skin.width_mm * random_between(random, 0.17, 3);
  }
  if (random() % 3 == 0) {
    view = TopView{random_place_on(skin, random), random_between(random, 0.2, 40)};
  } else {
    view = OrbitView{random_place_on(skin, random), random_between(random, -3.1, 3.1),
                     random_between(random, 0.1, 1.57), random_between(random, 30, 3000),
                     random_between(random, 0.3, 1.2)};
  }
  return situation;
}

constexpr int kSituations = 3000;

bool is_top(const View& view) { return std::holds_alternative<TopView>(view); }

/// The surface that applies to the view.
Surface shown_surface(const Situation& situation) {
  return is_top(situation.view) ? Surface{} : situation.surface;
}

/// Cosine between the line of sight and the surface normal at a point of the sheet.
double facing(const Situation& situation, Vec2 point) {
  const Surface surface = shown_surface(situation);
  const Pose frame = pose_at(surface, point);
  const Camera camera = camera_of(situation.view, surface, situation.viewport);
  const Vec3 sight = camera.perspective ? frame.position_mm - camera.eye : camera.forward;
  return dot(sight, frame.normal) / length(sight);
}

std::optional<Vec2> projected(const Situation& situation, Vec3 point) {
  return project(situation.view, situation.surface, situation.skin, situation.viewport, point);
}

std::optional<Vec2> picked(const Situation& situation, Vec2 pixel) {
  return pick(situation.view, situation.surface, situation.skin, situation.viewport, pixel);
}

struct Clip {
  double x, y, z, w;
};
Clip times(const Matrix& matrix, Vec3 p) {
  const auto row = [&](std::size_t i) {
    return matrix.at(i) * p.x + matrix.at(4 + i) * p.y + matrix.at(8 + i) * p.z + matrix.at(12 + i);
  };
  return {row(0), row(1), row(2), row(3)};
}

Clip clipped(const Situation& situation, Vec3 point) {
  return times(
      clip_from_world(situation.view, situation.surface, situation.skin, situation.viewport),
      point);
}

TEST(Views, PickFindsWhatProjectShows) {
  std::mt19937 random(1);
  int compared = 0;
  for (int i = 0; i < kSituations; ++i) {
    const Situation situation = random_situation(random);
    const Surface surface = shown_surface(situation);
    const Vec2 point = random_place_on(situation.skin, random);
    const Vec3 place = pose_at(surface, point).position_mm;
    const auto pixel = projected(situation, place);
    if (!pixel || std::abs(facing(situation, point)) < 0.02) continue;
    const auto found = picked(situation, *pixel);
    ASSERT_TRUE(found) << i;
    const Vec3 found_place = pose_at(surface, *found).position_mm;
    if (length(found_place - place) > 1e-6) {
      // Another part of the skin hides it.
      const Camera camera = camera_of(situation.view, surface, situation.viewport);
      EXPECT_LT(in_camera(camera, found_place).z, in_camera(camera, place).z) << i;
      continue;
    }
    ++compared;
    EXPECT_NEAR(found->x, point.x, 1e-6) << i;
    EXPECT_NEAR(found->y, point.y, 1e-6) << i;
  }
  EXPECT_GT(compared, kSituations / 2);
}

TEST(Views, PickFindsNothingBesideTheSkin) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    Situation situation = random_situation(random);
    situation.surface = {};
    Vec2 outside = random_place_on(situation.skin, random);
    outside.x = (i % 2 == 0 ? 0.501 : -0.501) * situation.skin.width_mm;
    const auto pixel = projected(situation, {outside.x, outside.y, 0});
    if (!pixel) continue;
    EXPECT_FALSE(picked(situation, *pixel));
  }
}

TEST(Views, MatrixShowsPointsWhereProjectSays) {
  std::mt19937 random(4);
  for (int i = 0; i < kSituations; ++i) {
    const Situation situation = random_situation(random);
    const Viewport& viewport = situation.viewport;
    const Surface surface = shown_surface(situation);
    const Pose frame = pose_at(surface, random_place_on(situation.skin, random));
    const Vec3 point = frame.position_mm + random_between(random, 0, kArrowMarginMm) * frame.normal;
    const auto pixel = projected(situation, point);
    const Clip clip = clipped(situation, point);
    EXPECT_EQ(pixel.has_value(), clip.w > 0);
    if (!pixel || clip.w < 5) continue;
    const double x = viewport.x + (clip.x / clip.w + 1) / 2 * viewport.width;
    const double y = viewport.y + (clip.y / clip.w + 1) / 2 * viewport.height;
    // Single precision: 1e-7 of the distance from the picture's middle or the eye.
    const double scale = 1 + std::abs(pixel->x) + std::abs(pixel->y) + 1e4 / clip.w;
    EXPECT_NEAR(x, pixel->x, 2e-4 * scale) << i;
    EXPECT_NEAR(y, pixel->y, 2e-4 * scale) << i;
  }
}

TEST(Views, DepthIsWithinVulkansRangeForAllArrowsAndGrowsWithTheWay) {
  std::mt19937 random(5);
  for (int i = 0; i < kSituations; ++i) {
    const Situation situation = random_situation(random);
    const Surface surface = shown_surface(situation);
    const Camera camera = camera_of(situation.view, surface, situation.viewport);
    const Pose frame = pose_at(surface, random_place_on(situation.skin, random));
    const Vec3 lean = random_between(random, -1, 1) * frame.tangent_x +
                      random_between(random, -1, 1) * frame.tangent_y +
                      random_between(random, 0.1, 1) * frame.normal;
    const Vec3 arrow = random_between(random, 0, kArrowMarginMm) / length(lean) * lean;
    double nearer = -1;
    // From the arrow's nearer end to the other one.
    const bool towards_eye = dot(arrow, camera.forward) < 0;
    for (const double share : {0.0, 0.5, 1.0}) {
      const Vec3 point = frame.position_mm + (towards_eye ? 1 - share : share) * arrow;
      const Clip clip = clipped(situation, point);
      const bool cut = camera.perspective && in_camera(camera, point).z < camera.distance_mm / 99;
      if (cut) break;
      EXPECT_GE(clip.z / clip.w, -1e-5) << i;
      EXPECT_LE(clip.z / clip.w, 1 + 1e-5) << i;
      EXPECT_GE(clip.z / clip.w, nearer - 1e-5) << i;
      nearer = clip.z / clip.w;
    }
  }
}

TEST(TopView, HasXToTheRightAndYUp) {
  const Viewport viewport{10, 20, 800, 600};
  const Situation situation{TopView{{5, 7}, 4}, {}, {100, 100}, viewport};
  const Vec2 middle = *projected(situation, {5, 7, 0});
  EXPECT_DOUBLE_EQ(middle.x, 410);
  EXPECT_DOUBLE_EQ(middle.y, 320);
  const Vec2 other = *projected(situation, {6, 9, 33});
  EXPECT_DOUBLE_EQ(other.x, 414);
  EXPECT_DOUBLE_EQ(other.y, 312) << "y goes down in pixels; height changes nothing";
  EXPECT_DOUBLE_EQ(pixels_per_mm(situation.view, viewport), 4);
}

}  // namespace
}  // namespace pillarfield::viewer
