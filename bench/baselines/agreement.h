#pragma once

#include <string_view>

#include "pillarfield/force_field.h"

namespace pillarfield::bench {

/// Throws Error that names the first pillar where forces or status bytes differ in any bit.
void require_same_bits(std::string_view opponent, const ForceFieldView& theirs,
                       const ForceFieldView& ours);

/// Throws Error that names the first pillar where status bytes differ, or a force by more than
/// `tolerance` of the magnitude of ours.
void require_near(std::string_view opponent, const ForceFieldView& theirs,
                  const ForceFieldView& ours, float tolerance);

}  // namespace pillarfield::bench
