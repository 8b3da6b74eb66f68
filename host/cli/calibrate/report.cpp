#include "cli/calibrate/report.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/json_text.h"
#include "cli/number_text.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostLines = 20;

void print_findings(const SkinCalibration& calibration,
                    const std::vector<SenselFinding>& findings) {
  fmt::print("Masked: {} of {} sensels\n", grouped(count_masked(calibration.planes)),
             grouped(std::size_t{calibration.rows} * calibration.cols));
  const std::size_t shown = std::min(findings.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const SenselFinding& finding = findings[i];
    fmt::print("  row {}, column {}: {}, reads {:.1f} counts{}\n", finding.row, finding.col,
               name_of(finding.fault), finding.mean_counts, finding.masked ? "" : "; not masked");
  }
  if (shown < findings.size()) {
    fmt::print("  and {} more; --json lists all\n", findings.size() - shown);
  }
}

void print_step_text(const StepReport& report, const SkinCalibration& calibration) {
  fmt::print("{}\n", report.headline);
  for (const StepFact& fact : report.facts) {
    if (fact.label.empty()) continue;
    const double scale = fact.unit.starts_with('%') ? 100 : 1;
    fmt::print("  {:<12} {:9.2f} {}\n", fact.label, scale * fact.value.get<double>(), fact.unit);
  }
  if (report.findings != nullptr) print_findings(calibration, *report.findings);
  for (const std::string& line : report.lines) fmt::print("{}\n", line);
}

void print_step_json(const StepReport& report, const SkinCalibration& calibration, Json json) {
  for (const StepFact& fact : report.facts) json[fact.key] = fact.value;
  if (report.findings != nullptr) {
    json["masked"] = count_masked(calibration.planes);
    json["findings"] = Json::array();
    for (const SenselFinding& finding : *report.findings) {
      json["findings"].push_back({{"row", finding.row},
                                  {"col", finding.col},
                                  {"fault", name_of(finding.fault)},
                                  {"masked", finding.masked},
                                  {"mean_counts", finding.mean_counts}});
    }
  }
  for (const StepFact& fact : report.more) json[fact.key] = fact.value;
  fmt::print("{}\n", json_text(json));
}

std::vector<std::string> names_of(const std::vector<std::string>& files) {
  std::vector<std::string> names;
  names.reserve(files.size());
  for (const std::string& file : files) {
    names.push_back(std::filesystem::path(file).filename().string());
  }
  return names;
}

}  // namespace

void add_residual(StepReport& report, const SensorEffects& effects) {
  if (!effects.residual) return;
  const auto& [relative, offset_counts] = *effects.residual;
  report.more.push_back({"residual_relative", relative});
  report.more.push_back({"residual_offset_counts", offset_counts});
  report.lines.push_back(
      fmt::format("Left: {:.2f} % of a reading and {:.2f} counts", 100 * relative, offset_counts));
}

void finish_step(const StepOptions& options, SkinCalibration calibration, const char* name,
                 const std::vector<std::string>& files, std::uint64_t frames,
                 const std::string& parameters, const StepReport& report) {
  calibration.history.push_back(step_done(name, names_of(files), frames, parameters));
  write_calibration_file(options.output, calibration, options.replace);
  if (options.json) {
    print_step_json(report, calibration, {{"output", options.output}, {"frames", frames}});
  } else if (!options.quiet) {
    print_step_text(report, calibration);
    fmt::print("Wrote {}\n", printable(options.output));
  }
}

}  // namespace pillarfield::cli
