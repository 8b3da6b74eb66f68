#include "cli/calibrate_report.h"

#include <fmt/format.h>

#include <algorithm>

namespace pillarfield::cli {
namespace {

constexpr std::size_t kMostLines = 20;

nlohmann::ordered_json json_of(const SenselFinding& finding) {
  return {{"row", finding.row},
          {"col", finding.col},
          {"fault", name_of(finding.fault)},
          {"masked", finding.masked},
          {"mean_counts", finding.mean_counts}};
}

}  // namespace

void add_findings(nlohmann::ordered_json& json, const SkinCalibration& calibration,
                  const std::vector<SenselFinding>& findings) {
  json["masked"] = count_masked(calibration.planes);
  json["findings"] = nlohmann::ordered_json::array();
  for (const SenselFinding& finding : findings) json["findings"].push_back(json_of(finding));
}

void print_findings(const SkinCalibration& calibration,
                    const std::vector<SenselFinding>& findings) {
  fmt::print("Masked: {} of {} sensels\n", count_masked(calibration.planes),
             std::size_t{calibration.rows} * calibration.cols);
  const std::size_t shown = std::min(findings.size(), kMostLines);
  for (std::size_t i = 0; i < shown; ++i) {
    const SenselFinding& finding = findings[i];
    fmt::print("  row {}, column {}: {}, reads {:.1f} counts{}\n", finding.row, finding.col,
               name_of(finding.fault), finding.mean_counts,
               finding.masked ? "" : "; suspected only, not masked");
  }
  if (shown < findings.size()) {
    fmt::print("  and {} more; --json lists all\n", findings.size() - shown);
  }
}

}  // namespace pillarfield::cli
