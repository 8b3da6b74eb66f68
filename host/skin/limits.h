#pragma once

#include "base/range.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield {

// Ranges of numbers that scenes, files, plans and the command line share.

// Numbers of SensorEffects whose keys in scenes differ from their parameters.
inline constexpr Range kShearCoefficient = {0.1, 10};
inline constexpr Range kPillarArmMm = {1e-3, 1e3};
inline constexpr Range kTileSensels = {2, 1024};  ///< rows or columns that share wires
inline constexpr Range kCurveCounts = {0, 1e9, true};

inline constexpr Range kBaselineTimeS = {1e-6, 1e9};  ///< of a followed baseline

inline constexpr Range kReachMm = {0, 1000};  ///< of ContactOptions

// Numbers of FrictionKnowledge.
inline constexpr Range kFrictions = {0.1, 9.9};
inline constexpr Range kPriorSpread = {0.01, 3};
inline constexpr Range kFrictionBound = {0.1, 100};

}  // namespace pillarfield
