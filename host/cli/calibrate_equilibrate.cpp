// pillarfield calibrate equilibrate: gains and dead zones from uniform pressure.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/json_text.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/equilibration.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

void print_json(const EquilibrateCommand& command, const EquilibrationResult& result,
                std::uint64_t frames) {
  nlohmann::ordered_json json = {{"output", command.output},
                                 {"frames", frames},
                                 {"levels", result.levels},
                                 {"counts_per_newton", *result.calibration.counts_per_newton},
                                 {"gain_spread", result.gain_spread},
                                 {"unevenness", result.unevenness},
                                 {"shear", result.shear}};
  if (result.levels > 1) json["dead_zone_counts"] = result.dead_zone_counts;
  if (result.levels > 2) json["nonlinearity"] = result.nonlinearity;
  add_findings(json, result.calibration, result.findings);
  fmt::print("{}\n", json_text(json));
}

void print_text(const EquilibrateCommand& command, const EquilibrationResult& result,
                std::uint64_t frames) {
  fmt::print(
      "Equilibrated {} x {} sensels from {} frames at {:g} kPa\n"
      "  gain          {:8.2f} % standard deviation, mean 1\n"
      "  sensitivity   {:8.2f} counts per newton and pillar\n",
      result.calibration.rows, result.calibration.cols, frames,
      fmt::join(command.pressures_kpa, ", "), 100 * result.gain_spread,
      *result.calibration.counts_per_newton);
  if (result.levels > 1) {
    fmt::print("  dead zone     {:8.2f} counts, the median\n", result.dead_zone_counts);
  }
  fmt::print("  unevenness    {:8.2f} % from pillar to pillar, beyond their sensels' own spread\n",
             100 * result.unevenness);
  fmt::print("  shear         {:8.2f} % of the normal force\n", 100 * result.shear);
  if (result.levels > 2) {
    fmt::print("  nonlinearity  {:8.2f} % of the answers, left by straight lines\n",
               100 * result.nonlinearity);
  }
  print_findings(result.calibration, result.findings);
  fmt::print("Wrote {}\n", printable(command.output));
}

void print_remarks(const EquilibrateCommand& command, const EquilibrationResult& result) {
  constexpr double kMuchShear = 0.03;
  if (result.shear <= kMuchShear) return;
  fmt::print(stderr,
             "{}: the press shears the skin by {:.1f} % of the normal force, which the gains "
             "take for their own; press straight\n",
             printable(command.files.back()), 100 * result.shear);
}

}  // namespace

void calibrate(const EquilibrateCommand& command) {
  const StepInput input = read_input(command.files, command);
  std::vector<UniformPress> presses;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    presses.push_back({input.files[i], command.pressures_kpa[i]});
  }
  EquilibrationResult result = equilibrate(input.before, presses, command.equilibration);
  result.calibration.history.push_back(step_done(
      "equilibrate", names_of(command.files), input.frames,
      fmt::format("pressures_kpa = {}, most_unevenness = {}", fmt::join(command.pressures_kpa, " "),
                  command.equilibration.most_unevenness)));
  write_calibration_file(command.output, result.calibration, command.replace);
  print_remarks(command, result);
  if (command.json) {
    print_json(command, result, input.frames);
  } else if (!command.quiet) {
    print_text(command, result, input.frames);
  }
}

}  // namespace pillarfield::cli
