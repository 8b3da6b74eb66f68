// pillarfield calibrate equilibrate: gains and dead zones from uniform pressure.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate.h"
#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/json_text.h"
#include "cli/number_range.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/equilibration.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

struct EquilibrateCommand {
  std::vector<std::string> files;
  std::vector<double> pressures_kpa;
  EquilibrationOptions equilibration;
  StepOptions step;
};

void print_json(const EquilibrateCommand& command, const EquilibrationResult& result,
                std::uint64_t frames) {
  nlohmann::ordered_json json = {{"output", command.step.output},
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
      "Equilibrated {} x {} sensels from {} frames at {} kPa\n"
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
  fmt::print("Wrote {}\n", printable(command.step.output));
}

void print_remarks(const EquilibrateCommand& command, const EquilibrationResult& result) {
  constexpr double kMuchShear = 0.03;
  if (result.shear <= kMuchShear) return;
  fmt::print(stderr,
             "{}: the press shears the skin by {:.1f} % of the normal force, which the gains "
             "take for their own; press straight\n",
             printable(command.files.back()), 100 * result.shear);
}

void run(const EquilibrateCommand& command) {
  const StepInput input = read_input(command.files, command.step);
  std::vector<UniformPress> presses;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    presses.push_back({input.files[i], command.pressures_kpa[i]});
  }
  EquilibrationResult result = equilibrate(input.before, presses, command.equilibration);
  result.calibration.history.push_back(step_done(
      "equilibrate", names_of(command.files), input.frames,
      fmt::format("pressures_kpa = {}, most_unevenness = {}", fmt::join(command.pressures_kpa, " "),
                  command.equilibration.most_unevenness)));
  write_calibration_file(command.step.output, result.calibration, command.step.replace);
  print_remarks(command, result);
  if (command.step.json) {
    print_json(command, result, input.frames);
  } else {
    print_text(command, result, input.frames);
  }
}

}  // namespace

void add_calibrate_equilibrate(CLI::App& calibrate, Work& work) {
  const auto options = std::make_shared<EquilibrateCommand>();
  CLI::App* const command = calibrate.add_subcommand(
      "equilibrate", "Gains, and with several pressures dead zones, from uniform pressure");
  command->add_option("UNIFORM", options->files, "Frames under uniform pressure, a file for each")
      ->required();
  command
      ->add_option("--pressure-kpa", options->pressures_kpa,
                   "Pressure of each file, in their order: P1,P2,...")
      ->required()
      ->check(number_range(1e-6, 1e6).description(""))
      ->delimiter(',')
      ->allow_extra_args(false);
  add_calibration_option(*command, options->step);
  command
      ->add_option("--max-unevenness", options->equilibration.most_unevenness,
                   "Largest share by which the pressure may vary from pillar to pillar")
      ->check(number_range(0, 1e6).description(""))
      ->capture_default_str();
  add_step_options(*command, options->step, "Calibration to write (HDF5)");
  command->callback([options, &work] {
    require_one_each("--pressure-kpa", options->files, options->pressures_kpa);
    work = [options] { run(*options); };
  });
}

}  // namespace pillarfield::cli
