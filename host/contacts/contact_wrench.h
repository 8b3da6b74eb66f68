#pragma once

#include <span>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Force and moment of the pillars of runs, summed in their order. `poses` has one pose a pillar of
/// the field. NaN and infinite forces count as zero.
[[nodiscard]] Wrench wrench_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                               std::span<const Pose> poses);

/// Adds a wrench about the same point.
void add(Wrench& sum, const Wrench& wrench);

}  // namespace pillarfield
