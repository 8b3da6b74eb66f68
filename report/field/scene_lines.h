#pragma once

#include <string>
#include <vector>

#include "tests/core/field_study.h"

namespace pillarfield::report {

/// A line of plain text for each scene: what the estimator makes of it with nothing said, beside
/// the middle of θ and the middle of the segment; below them a line for each kind of motion. For
/// whoever tunes. `sweeps`: of the relaxation.
[[nodiscard]] std::string scene_lines(const std::vector<field_study::Scene>& scenes, int sweeps);

}  // namespace pillarfield::report
