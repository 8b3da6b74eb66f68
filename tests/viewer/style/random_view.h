#pragma once

#include <random>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// A view on some skin, as a user may have turned it.
struct Situation {
  View view;
  Surface surface;
  SkinSize skin;
  Viewport viewport;
};

inline double random_between(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

inline Vec2 random_place_on(const SkinSize& skin, std::mt19937& random, double share = 0.999) {
  const double x = random_between(random, -share, share) * skin.width_mm / 2;
  return {x, random_between(random, -share, share) * skin.height_mm / 2};
}

inline Situation random_situation(std::mt19937& random) {
  Situation situation;
  auto& [view, surface, skin, viewport] = situation;
  skin = {random_between(random, 20, 1200), random_between(random, 20, 1200)};
  viewport = {random_between(random, 0, 300), random_between(random, 0, 200),
              random_between(random, 200, 2000), random_between(random, 200, 1500)};
  if (random() % 2 == 0) {
    surface = {SurfaceKind::cylinder, skin.width_mm * random_between(random, 0.17, 3)};
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

}  // namespace pillarfield::viewer
