#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield::cli {

/// Adds "masked", the number of sensels that the calibration has as missing, and "findings".
void add_findings(nlohmann::ordered_json& json, const SkinCalibration& calibration,
                  const std::vector<SenselFinding>& findings);

/// The same as text, the first twenty findings one to a line.
void print_findings(const SkinCalibration& calibration, const std::vector<SenselFinding>& findings);

}  // namespace pillarfield::cli
