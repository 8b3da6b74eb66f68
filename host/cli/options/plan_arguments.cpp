// Options of sensor, solver, contacts and device, which several commands have, and their plan.

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "cli/options/shared_arguments.h"
#include "cli/stream/replay.h"
#include "cli/warnings.h"
#include "pipeline/plan_settings.h"
#include "skin/limits.h"

namespace pillarfield::cli {
namespace {

/// Adds the numbers of a heading of the help.
void add_settings(Group& group, const char* heading, PlanSettings& settings) {
  for (const PlanSetting& setting : kPlanSettings) {
    if (setting.option == nullptr || std::string_view(setting.heading) != heading) continue;
    std::optional<double>& target = settings.*setting.member;
    const auto& [low, high, open_low, open_high] = setting.range;
    if (setting.whole) {
      group.whole(setting.option, target, setting.unit, setting.help,
                  static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high));
    } else {
      group.number(setting.option, target, setting.unit, setting.help, low, high);
    }
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
  Group sensor(command, "Sensor");
  add_settings(sensor, "Sensor", plan.settings);
}

void add_solver(CLI::App* command, PlanOptions& plan) {
  PlanSettings& settings = plan.settings;
  Group solver(command, "Solver");
  solver.choice<Estimator>(
      "--estimator", settings.estimator,
      {{"direct", Estimator::direct}, {"paper", Estimator::paper}, {"contact", Estimator::contact}},
      "contact: ambiguous pillars from the friction of their contact, in earlier frames too; "
      "direct: each pillar from its own readings; paper: the paper's equations "
      "[contact; without pillars direct]");
  solver
      .text(
          "--outputs", settings.outputs, "WORDS",
          "Planes to compute, separated by commas: forces; angles adds magnitude, theta and "
          "phi; uncertainty adds standard deviations and intervals; pressure adds it to files, kPa "
          "[forces]")
      ->check(one_of({"forces", "angles", "uncertainty", "pressure"}))
      ->delimiter(',');
  add_settings(solver, "Solver", settings);
  solver.flag("--everything", settings.everything,
              "All outputs, the parity test and --follow-baseline; needs the noise");
  Group friction(command, "Friction");
  add_settings(friction, "Friction", settings);
  friction
      .number("--friction-prior", settings.friction_prior, "MEDIAN,SPREAD",
              "Log-normal prior of friction coefficients [1,0.5]", kPriorSpread.low,
              kFrictions.high)
      ->expected(2)
      ->delimiter(',');
  friction.flag("--unrelated-frames", settings.unrelated_frames,
                "Carry no friction over from earlier frames");
}

void add_device(CLI::App* command, std::string& name) {
  Group device(command, "Device");
  device.text(
      "--device", name, "DEVICE",
      "host, opencl, or an OpenCL device by index or part of its name [host for small skins, "
      "else the best of OpenCL]; see info --devices");
}

void add_contacts(CLI::App* command, ContactOptions& options) {
  Group contacts(command, "Contacts");
  contacts.whole("--minimum-pillars", options.minimum_pillars, "N",
                 "Leave out contacts of fewer pillars [1]", 0,
                 std::numeric_limits<std::uint32_t>::max());
  contacts.number("--contact-reach", options.reach_mm, "MM",
                  "Largest movement of a contact between frames [10]", kReachMm.low, kReachMm.high);
}

SolverPlan plan_of(PlanOptions options, SolverPlan plan, const std::string& source,
                   const std::function<double()>& frame_interval_s) {
  if (options.scene.empty() && is_scene(source)) options.scene = source;
  if (!options.scene.empty()) static_cast<void>(load_scene_with_warnings(options.scene));
  return build_plan(std::move(plan), options, source, frame_interval_s);
}

}  // namespace pillarfield::cli
