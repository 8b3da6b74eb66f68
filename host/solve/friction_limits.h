#pragma once

#include "base/range.h"

namespace pillarfield {

// Ranges of the members of FrictionKnowledge, also for scenes and the command line.
inline constexpr Range kFrictions = {0.1, 9.9};
inline constexpr Range kPriorSpread = {0.01, 3};
inline constexpr Range kFrictionBound = {0.1, 100};

}  // namespace pillarfield
