#pragma once

#include "pillarfield/calibration.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Throws Error, its place being `where`, unless every plane is empty or has a value for each
/// sensel in range: |tare| and dead_zone up to kMaxCounts, dead_zone >= 0, gain in [0.01, 100],
/// mask 0 or 1.
void check(const Calibration& calibration, const Skin& skin, const char* where);

}  // namespace pillarfield
