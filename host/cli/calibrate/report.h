#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield::cli {

/// A result of a step: a key of JSON and, with a label, a line of text. Units that begin with "%"
/// scale the value by 100 in text.
struct StepFact {
  const char* key;
  nlohmann::ordered_json value;
  std::string label = {};
  std::string unit = {};
};

struct StepReport {
  std::string headline;
  std::vector<StepFact> facts;
  const std::vector<SenselFinding>* findings = nullptr;  ///< of steps that find faults
  std::vector<StepFact> more = {};                       ///< JSON after the findings
  std::vector<std::string> lines = {};                   ///< text after the findings
};

/// Adds the residual error that a step stored.
void add_residual(StepReport& report, const SensorEffects& effects);

/// Adds the step `name` to the calibration's history, writes it and prints the report.
void finish_step(const StepOptions& options, SkinCalibration calibration, const char* name,
                 const std::vector<std::string>& files, std::uint64_t frames,
                 const std::string& parameters, const StepReport& report);

}  // namespace pillarfield::cli
