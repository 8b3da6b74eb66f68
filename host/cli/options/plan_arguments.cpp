// Options of sensor, solver, contacts and device, which several commands have, and their plan.

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cli/options/shared_arguments.h"
#include "cli/stream/replay.h"
#include "cli/warnings.h"
#include "skin/limits.h"

namespace pillarfield::cli {
namespace {

/// Adds the numbers of a heading of the help.
void add_settings(CLI::App* command, const char* heading, PlanSettings& settings) {
  for (const PlanSetting& setting : kPlanSettings) {
    if (setting.option == nullptr || std::string_view(setting.heading) != heading) continue;
    add_setting(command, setting, settings);
  }
}

}  // namespace

void add_sensor(CLI::App* command, PlanOptions& plan) {
  Group input(command, "Input");
  input.text("--scene", plan.scene, "FILE",
             "Scene to take the sensor's constants and the solver's settings from");
  input.text("--calibration", plan.calibration, "FILE",
             "Calibration to take planes and constants from");
  add_trust(command, plan.read);
  add_settings(command, "Sensor", plan.settings);
}

void add_solver(CLI::App* command, PlanOptions& plan) {
  PlanSettings& settings = plan.settings;
  Group solver(command, "Solver");
  solver.choice("--estimator", settings.estimator, kEstimators,
                "contact: ambiguous pillars from the friction of their contact, in earlier frames "
                "too; direct: each pillar from its own readings; paper: the paper's equations "
                "[contact; without pillars direct]");
  std::vector<std::string> outputs = {"forces"};
  for (const PlanOutput& output : kPlanOutputs) outputs.emplace_back(output.name);
  command
      ->add_option_function<std::vector<std::string>>(
          "--outputs",
          [&settings](const std::vector<std::string>& words) { set_outputs(words, settings); },
          "Planes to compute, separated by commas: forces; angles adds magnitude, theta and "
          "phi; uncertainty adds standard deviations and intervals; pressure adds it to files, kPa "
          "[forces]")
      ->type_name("WORDS")
      ->group("Solver")
      ->check(one_of(outputs))
      ->delimiter(',');
  add_settings(command, "Solver", settings);
  solver.flag("--everything", settings.everything,
              "All outputs, the parity test and --follow-baseline; needs the noise");
  Group friction(command, "Friction");
  add_settings(command, "Friction", settings);
  friction
      .number("--friction-prior", settings.friction_prior, "MEDIAN,SPREAD",
              "Log-normal prior of friction coefficients [1,0.5]", kPriorSpread.low,
              kFrictions.high)
      ->expected(2)
      ->delimiter(',');
  friction.flag_callback(
      "--unrelated-frames", [&settings] { settings.unrelated_frames = true; },
      "Carry no friction over from earlier frames");
}

void add_device(CLI::App* command, std::string& name) {
  Group device(command, "Device");
  device.text(
      "--device", name, "DEVICE",
      "host, opencl, or an OpenCL device by index or part of its name [host for small skins, "
      "else the best of OpenCL]; see info --devices");
}

std::array<CLI::Option*, 2> add_contacts(CLI::App* command, ContactOptions& options) {
  Group contacts(command, "Contacts");
  return {contacts.whole("--minimum-pillars", options.minimum_pillars, "N",
                         "Leave out contacts of fewer pillars [1]", 0,
                         std::numeric_limits<std::uint32_t>::max()),
          contacts.number("--contact-reach", options.reach_mm, "MM",
                          "Largest movement of a contact between frames [10]", kReachMm.low,
                          kReachMm.high)};
}

SolverPlan plan_of(PlanOptions options, SolverPlan plan, const std::string& source,
                   const std::function<double()>& frame_interval_s) {
  if (options.scene.empty() && is_scene(source)) options.scene = source;
  if (!options.scene.empty()) static_cast<void>(load_scene_with_warnings(options.scene));
  return build_plan(std::move(plan), options, source, frame_interval_s);
}

}  // namespace pillarfield::cli
