#pragma once

#include <string_view>

#include "pillarfield/force_field.h"

namespace pillarfield::bench {

/// Throws an Error that names the first pillar whose force or status differs in any bit.
void require_same_bits(std::string_view baseline, const ForceFieldView& theirs,
                       const ForceFieldView& ours);

/// Throws an Error that names the first pillar whose status differs, or whose force differs by more
/// than `tolerance` times the magnitude of ours.
void require_near(std::string_view baseline, const ForceFieldView& theirs,
                  const ForceFieldView& ours, float tolerance);

}  // namespace pillarfield::bench
