// pillarfield calibrate equilibrate: gains and dead zones from uniform pressure.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

void warn_of_shear(const EquilibrateCommand& command, double shear) {
  constexpr double kMuchShear = 0.03;
  if (shear <= kMuchShear) return;
  fmt::print(
      stderr,
      "{}: shear is {:.1f} % of the normal force and biases the gains; press without shear\n",
      printable(command.files.back()), 100 * shear);
}

const char* name_of(ResponseModel model) {
  return model == ResponseModel::curve ? "curve" : "linear";
}

void add_held_out(StepReport& report, const char* key, const std::optional<double>& residual,
                  const char* what) {
  if (!residual) return;
  report.facts.push_back(
      {key, *residual, "held out",
       std::string("% residual of ") + what + " on pressures that the fit left out"});
}

}  // namespace

void calibrate(const EquilibrateCommand& command) {
  const StepInput input = read_input(command.files, command);
  std::vector<UniformPress> presses;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    presses.push_back({input.files[i], command.pressures_kpa[i]});
  }
  const EquilibrationResult result = equilibrate(input.calibration, presses, command.equilibration);
  const SkinCalibration& calibration = result.calibration;
  StepReport report = {
      .headline = fmt::format("Equilibrated {} x {} sensels from {} at {:g} kPa", calibration.rows,
                              calibration.cols, counted(input.frames, "frame"),
                              fmt::join(command.pressures_kpa, ", ")),
      .facts = {{"levels", result.levels},
                {"counts_per_newton", *calibration.counts_per_newton, "sensitivity",
                 "counts per newton and pillar"},
                {"gain_spread", result.gain_spread, "gain", "% standard deviation, mean 1"},
                {"unevenness", result.unevenness, "unevenness",
                 "% from pillar to pillar, beyond the spread of their sensels"},
                {"shear", result.shear, "shear", "% of the normal force"}},
      .findings = &result.findings};
  if (result.levels > 1) {
    report.facts.push_back(
        {"dead_zone_counts", result.dead_zone_counts, "dead zone", "counts, median"});
  }
  if (result.levels > 2) {
    report.facts.push_back({"nonlinearity", result.nonlinearity, "nonlinearity",
                            "% of the response, residual of the fits"});
  }
  report.facts.push_back({"model", name_of(result.model)});
  add_held_out(report, "held_out_linear", result.held_out_linear, "straight lines");
  add_held_out(report, "held_out_curve", result.held_out_curve, "a common curve");
  report.lines.push_back(fmt::format("Model: {}", name_of(result.model)));
  add_residual(report, calibration.planes.effects);
  warn_of_shear(command, result.shear);
  finish_step(command, calibration, "equilibrate", command.files, input.frames,
              fmt::format("pressures_kpa = {}, most_unevenness = {}, model = {}",
                          fmt::join(command.pressures_kpa, " "),
                          command.equilibration.most_unevenness, name_of(result.model)),
              report);
}

}  // namespace pillarfield::cli
