#pragma once

#include <string>
#include <vector>

#include "pillarfield/coverage.h"
#include "pillarfield/scene.h"

/// Scenes with known truth on which the stated uncertainty is held against the truth.
namespace pillarfield::coverage_study {

/// A scene and what it is like, for readers.
struct Study {
  std::string name;
  Scene scene;
};

/// All directions with large and with small forces, and bodies on a skin: whole counts, unequal
/// sensels, dead zones, tares, and a threshold of four standard deviations of a reading's noise.
[[nodiscard]] const std::vector<Study>& studies();

/// The coverage of all frames of a scene, and of parts of their pillars: by what noise did to the
/// sensels that are near the border of being usable.
struct Parted {
  Coverage all;
  Coverage rightly_read;  ///< the usable sensels are those that would be without noise
  Coverage by_luck;       ///< some are usable by luck: noise inactive them above the threshold
  Coverage by_bad_luck;   ///< none is, but some are silent by bad luck
};
[[nodiscard]] Parted cover(const Scene& scene);

}  // namespace pillarfield::coverage_study
