#pragma once

#include <span>

#include "core/friction_plateau.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// Adds the ratios of those pillars whose readings determine their force and that bear a quarter of
/// `peak_n`, newtons, or more; none where that is not above zero. Each weighs as much of
/// FrictionHistogram::kMostWeight as it bears of the peak.
void add_ratios(const ForceFieldView& forces, std::span<const ContactRun> runs, float peak_n,
                FrictionHistogram& histogram);

}  // namespace pillarfield
