#pragma once

#include <cstdint>

#include "core/friction_plateau.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// Adds the ratios of those pillars of a run whose readings determine their force and that bear a
/// quarter of `peak`, quanta, or more. Each weighs as much of FrictionHistogram::kMostWeight as it
/// bears of the peak.
void add_ratios(const ForceFieldView& forces, const ContactRun& run, std::int64_t peak,
                FrictionHistogram& histogram);

}  // namespace pillarfield
