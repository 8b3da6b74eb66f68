#pragma once

#include <string>
#include <vector>

#include "pillarfield/coverage.h"
#include "pillarfield/scene.h"

/// Coverage of the stated uncertainty on simulated scenes.
namespace pillarfield::coverage_study {

/// A scene and its description.
struct Study {
  std::string name;
  Scene scene;
};

/// All directions with large and with small forces, and indenters on a skin: whole counts, unequal
/// sensels, dead zones, tares, and a threshold of four standard deviations of a reading's noise.
[[nodiscard]] const std::vector<Study>& studies();

/// The coverage of all frames of a scene, and of parts of their pillars: by what noise did to the
/// sensels that are near the border of being usable.
struct Parted {
  Coverage all;
  Coverage rightly_read;  ///< the usable sensels are those that would be without noise
  Coverage by_luck;       ///< some are usable by luck: noise raised them above the threshold
  Coverage by_bad_luck;   ///< none is, but noise made some inactive
};
[[nodiscard]] Parted cover(const Scene& scene);

}  // namespace pillarfield::coverage_study
