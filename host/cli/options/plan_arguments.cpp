// Options of sensor, solver, contacts and device, which several commands have.

#include <limits>

#include "cli/options/shared_arguments.h"
#include "skin/limits.h"

namespace pillarfield::cli {

void add_sensor(CLI::App* command, PlanOptions& plan) {
  Group input(command, "Input");
  input.text("--scene", plan.scene, "FILE",
             "Scene to take the sensor's constants and the solver's settings from");
  input.text("--calibration", plan.calibration, "FILE",
             "Calibration to take planes and constants from");
  add_trust(command, plan.read);
  Group sensor(command, "Sensor");
  sensor.number("--threshold", plan.threshold_counts, "COUNTS",
                "Readings above this are usable [the file's]");
  sensor.number("--counts-per-newton", plan.counts_per_newton, "COUNTS",
                "Counts per newton and pillar [the file's]");
  sensor.number("--full-scale", plan.full_scale_counts, "COUNTS",
                "Readings of this or more are saturated [the file's]");
  sensor.number("--noise", plan.noise_counts, "COUNTS",
                "Standard deviation of a reading [the calibration's or scene's]");
  sensor.number("--follow-baseline", plan.baseline_time_s, "SECONDS",
                "Time constant with which the tare of untouched sensels follows drift [constant "
                "tare]",
                1e-6, 1e9);
  sensor.whole("--baseline-interval", plan.baseline_interval, "N",
               "Follow it in one of N pillar rows per frame, at 1/N of the cost [1; with "
               "--everything up to 64]",
               1, 1024);
}

void add_solver(CLI::App* command, PlanOptions& plan) {
  Group solver(command, "Solver");
  solver.choice<Estimator>(
      "--estimator", plan.estimator,
      {{"direct", Estimator::direct}, {"paper", Estimator::paper}, {"contact", Estimator::contact}},
      "direct: each pillar from its own readings; paper: the paper's equations; contact: "
      "ambiguous pillars from the friction of their contact [direct]",
      "field", "contact");
  solver
      .text("--outputs", plan.outputs, "WORDS",
            "Planes to compute, separated by commas: forces; angles adds magnitude, theta and "
            "phi; uncertainty adds standard deviations and intervals [forces]")
      ->check(one_of({"forces", "angles", "uncertainty"}))
      ->delimiter(',');
  solver.number("--segment-point", plan.segment_point, "RATIO",
                "Reported point of a region 3 pillar on its feasible segment, as a fraction of the "
                "largest normal force; 0.5 minimises the largest error [0.875]",
                1e-6, 1);
  solver.number("--parity-tolerance", plan.parity_tolerance_counts, "COUNTS",
                "Flag pillars whose parity residual is larger [not tested]");
  solver.flag("--everything", plan.everything,
              "All outputs, the parity test and --follow-baseline; needs the noise");
  Group friction(command, "Friction");
  friction.number("--friction", plan.friction, "RATIO",
                  "Friction coefficient of all contacts, known to 3 % [estimated]", kFrictions.low,
                  kFrictions.high);
  friction.number("--friction-bound", plan.friction_bound, "RATIO",
                  "Upper bound of friction coefficients [none]", kFrictionBound.low,
                  kFrictionBound.high);
  friction
      .number("--friction-prior", plan.friction_prior, "MEDIAN,SPREAD",
              "Log-normal prior of friction coefficients [1,0.5]", kPriorSpread.low,
              kFrictions.high)
      ->expected(2)
      ->delimiter(',');
  friction.flag("--unrelated-frames", plan.unrelated_frames,
                "Carry no friction over from earlier frames");
}

void add_device(CLI::App* command, DeviceOptions& options) {
  Group device(command, "Device");
  device.text("--device", options.name, "DEVICE",
              "OpenCL device, by index or part of its name [the best]; see info --devices");
  device.choice<Memory>(
      "--memory", options.memory,
      {{"auto", Memory::automatic}, {"shared", Memory::shared}, {"staged", Memory::staged}},
      "shared: zero copy; staged: copied to the device [auto]");
}

void add_contacts(CLI::App* command, ContactOptions& options) {
  Group contacts(command, "Contacts");
  contacts.whole("--minimum-pillars", options.minimum_pillars, "N",
                 "Leave out contacts of fewer pillars [1]", 0,
                 std::numeric_limits<std::uint32_t>::max());
  contacts.number("--contact-reach", options.reach_mm, "MM",
                  "Largest movement of a contact between frames [10]");
}

}  // namespace pillarfield::cli
