// The options of the calibration steps, their help and its examples.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cli/options/shared_arguments.h"
#include "skin/limits.h"

namespace pillarfield::cli {
namespace {

/// Adds the arguments of all steps.
void add_step(CLI::App* command, StepOptions& options, bool needs_calibration, const char* output,
              bool uses_times = false) {
  if (needs_calibration) {
    Group(command, "Input")
        .text("--calibration", options.calibration, "FILE", "Calibration to extend")
        ->required();
  }
  add_trust(command, options.read);
  add_plain_data(command, options.read, uses_times);
  add_output(command, options, output);
  add_general(command, options, "Print the summary as JSON", kQuietWriter);
}

constexpr const char* kCalibration = "Calibration (HDF5)";

// Examples of several steps.
constexpr const char* kIdleSkin =
    "  pillarfield simulate scenes/new_skin_idle.toml --uncalibrated -o idle.h5\n"
    "  pillarfield calibrate tare idle.h5 -o tared.h5\n";
constexpr const char* kPressedSkin =
    "  pillarfield simulate scenes/new_skin_idle.toml --uncalibrated -o idle.h5\n"
    "  pillarfield simulate scenes/new_skin_pressed.toml --uncalibrated -o pressed.h5\n"
    "  pillarfield calibrate tare idle.h5 -o tared.h5\n";

/// Throws unless `option` has one value per file.
void require_one_each(const char* option, const std::vector<std::string>& files,
                      std::size_t values) {
  if (files.size() == values) return;
  throw CLI::ValidationError(
      option, fmt::format("{} files and {} values; give one per file", files.size(), values));
}

void add_tare(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<TareCommand>(
      parent, work, calibrate, "tare",
      "Tare, noise and threshold from frames of the unloaded skin.",
      std::string(kIdleSkin) +
          "  pillarfield calibrate tare idle.h5 -o strict.h5 --threshold-factor 6\n");
  Group input(command, "Input");
  input.file("UNLOADED", options->unloaded, "Frames in which nothing touches the skin");
  input.text("--calibration", options->calibration, "FILE",
             "Calibration whose tare is replaced [none]");
  Group step(command, "Tare");
  step.number("--threshold-factor", options->tare.threshold_factor, "RATIO",
              "Threshold as a multiple of the noise of a reading [4]", 0, kMaxThresholdFactor);
  step.flag("--preloaded", options->tare.preloaded,
            "Accept readings that resemble a touch, as of a bent or covered skin");
  add_step(command, *options, false, kCalibration);
}

void add_equilibrate(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<EquilibrateCommand>(
      parent, work, calibrate, "equilibrate",
      "Gains, and from several pressures dead zones and a response curve, under uniform pressure.",
      std::string(kPressedSkin) +
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration "
          "tared.h5 "
          "-o equal.h5\n"
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --model linear "
          "--calibration tared.h5 -o lines.h5\n");
  Group(command, "Input")
      .file("UNIFORM", options->files, "Frames under uniform pressure, one file per pressure");
  Group step(command, "Equilibration");
  step.numbers("--pressure-kpa", options->pressures_kpa, "P1,P2,...",
               "Pressure of each file, in order");
  step.number("--max-unevenness", options->equilibration.most_unevenness, "RATIO",
              "Largest variation of the pressure from pillar to pillar [0.1]", 0, 1e6);
  step.choice<ResponseModel>(
      "--model", options->equilibration.model,
      {{"linear", ResponseModel::linear}, {"curve", ResponseModel::curve}},
      "linear: a straight line for each sensel; curve: a response that all share, from two "
      "pressures or more [the better one on held-out pressures]");
  add_step(command, *options, true, kCalibration);
  command->parse_complete_callback([options = options] {
    require_one_each("--pressure-kpa", options->files, options->pressures_kpa.size());
  });
}

void add_load(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<LoadCommand>(
      parent, work, calibrate, "load", "Counts per newton, and a power law, from known loads.",
      std::string(kPressedSkin) +
          "  pillarfield calibrate load pressed.h5 --load-n 200 --calibration tared.h5 -o "
          "loaded.h5\n");
  Group(command, "Input")
      .file("FRAMES", options->files, "Frames under a constant load, one file per load");
  Group step(command, "Load");
  step.numbers("--load-n", options->loads_n, "L1,L2,...", "Normal load of each file, in order");
  step.choice<LoadModel>("--model", options->model,
                         {{"linear", LoadModel::linear}, {"power", LoadModel::power}},
                         "linear: proportional; power: power law, from at least two loads "
                         "[linear]");
  add_step(command, *options, true, kCalibration);
  command->parse_complete_callback([options = options] {
    require_one_each("--load-n", options->files, options->loads_n.size());
  });
}

void add_shear(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<ShearCommand>(
      parent, work, calibrate, "shear", "Shear coefficients from known tangential loads.",
      std::string(kPressedSkin) +
          "  pillarfield simulate scenes/new_skin_sheared.toml --uncalibrated -o sheared.h5\n"
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration "
          "tared.h5 -o equal.h5\n"
          "  pillarfield calibrate shear sheared.h5 --shear-n 50,0 --load-n 200 --calibration "
          "equal.h5 -o "
          "shear.h5\n");
  Group(command, "Input")
      .file("SHEARED", options->files,
            "Frames of bodies that do not slip under a tangential load, one file per load");
  Group step(command, "Load");
  step.number("--shear-n", options->shears_n, "X1,Y1,X2,Y2,...",
              "Tangential force on the skin of each file, in order: + right, + up", -1e6, 1e6)
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  step.number("--load-n", options->loads_n, "N1,N2,...",
              "Normal force of each file, so that errors of the sensitivity and creep cancel "
              "[unknown]",
              1e-6, 1e6)
      ->delimiter(',')
      ->allow_extra_args(false);
  add_step(command, *options, true, kCalibration);
  command->parse_complete_callback([options = options] {
    if (!options->loads_n.empty()) {
      require_one_each("--load-n", options->files, options->loads_n.size());
    }
    if (options->shears_n.size() == 2 * options->files.size()) return;
    throw CLI::ValidationError(
        "--shear-n", fmt::format("{} files and {} values; give two per file", options->files.size(),
                                 options->shears_n.size()));
  });
}

void add_arm(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<ArmCommand>(
      parent, work, calibrate, "arm",
      "Arm of off-centre pressure, from bodies pressed straight down.",
      std::string(kPressedSkin) +
          "  pillarfield simulate scenes/leaning_skin_pressed.toml --uncalibrated -o balls.h5\n"
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration "
          "tared.h5 -o equal.h5\n"
          "  pillarfield calibrate arm balls.h5 --calibration equal.h5 -o arm.h5\n");
  Group(command, "Input")
      .file("PRESSED", options->files,
            "Frames of bodies at rest that press straight down, one file per placement");
  add_step(command, *options, true, kCalibration);
}

void add_leak(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<LeakCommand>(
      parent, work, calibrate, "leak",
      "Leaks between sensels and between pillars, from a fine tip on single pillars.",
      std::string(kIdleSkin) +
          "  pillarfield simulate scenes/leaking_skin_pressed.toml --uncalibrated -o pressed.h5\n"
          "  pillarfield simulate scenes/leaking_skin_tip.toml --uncalibrated -o tip.h5\n"
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration "
          "tared.h5 -o equal.h5\n"
          "  pillarfield calibrate leak tip.h5 --calibration equal.h5 -o leak.h5\n");
  Group(command, "Input")
      .file("TIP", options->files, "Frames in which a fine tip presses one pillar after another");
  add_step(command, *options, true, kCalibration);
}

void add_memory(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<MemoryCommand>(
      parent, work, calibrate, "memory",
      "Hysteresis and creep, under uniform pressure that rises, rests and falls.",
      std::string(kIdleSkin) +
          "  pillarfield simulate scenes/creeping_skin_pressed.toml --uncalibrated -o pressed.h5\n"
          "  pillarfield simulate scenes/creeping_skin_cycles.toml --uncalibrated -o cycles.h5\n"
          "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 187.5 --calibration "
          "tared.h5 -o equal.h5\n"
          "  pillarfield calibrate memory cycles.h5 --pressure scenes/creeping_skin_cycles.csv "
          "--calibration equal.h5 -o memory.h5\n");
  Group input(command, "Input");
  input.file("CYCLES", options->files,
             "Frames from a rested skin on, under uniform pressure that changes");
  input
      .text("--pressure", options->logs, "FILE",
            "Log of the pressure of each file, in order: lines of time (s), pressure (kPa)")
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  add_step(command, *options, true, kCalibration, true);
  command->parse_complete_callback([options = options] {
    require_one_each("--pressure", options->files, options->logs.size());
  });
}

void add_bending(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<BendingCommand>(
      parent, work, calibrate, "bending",
      "Change of the tares with curvature, from the unloaded skin on known cylinders.",
      std::string(kIdleSkin) +
          "  pillarfield simulate scenes/bent_skin_x.toml --uncalibrated -o x.h5\n"
          "  pillarfield simulate scenes/bent_skin_y.toml --uncalibrated -o y.h5\n"
          "  pillarfield simulate scenes/bent_skin_xy.toml --uncalibrated -o xy.h5\n"
          "  pillarfield calibrate bending x.h5 y.h5 xy.h5 --radius-mm 60,60,60 --axis-deg "
          "90,0,45 --calibration tared.h5 -o bending.h5\n");
  Group(command, "Input")
      .file("BENT", options->files, "Frames of the unloaded skin, one file per cylinder");
  Group step(command, "Bending");
  step.number("--radius-mm", options->radii_mm, "R1,R2,...",
              "Radius of each cylinder, in order; below zero inside of one", -1e6, 1e6)
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  step.number("--axis-deg", options->axes_deg, "A1,A2,...",
              "Angle of each axis from +x, counter-clockwise, in order", -360, 360)
      ->required()
      ->delimiter(',')
      ->allow_extra_args(false);
  add_step(command, *options, true, kCalibration);
  command->parse_complete_callback([options = options] {
    require_one_each("--radius-mm", options->files, options->radii_mm.size());
    require_one_each("--axis-deg", options->files, options->axes_deg.size());
    if (std::ranges::find(options->radii_mm, 0) == options->radii_mm.end()) return;
    throw CLI::ValidationError("--radius-mm", "a radius is 0");
  });
}

void add_wires(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<WiresCommand>(
      parent, work, calibrate, "wires",
      "Row and column crosstalk, from a body at rest while another one presses elsewhere.",
      "  pillarfield simulate scenes/wired_skin_alone.toml --uncalibrated -o alone.h5\n"
      "  pillarfield simulate scenes/wired_skin_row.toml --uncalibrated -o row.h5\n"
      "  pillarfield simulate scenes/wired_skin_column.toml --uncalibrated -o column.h5\n"
      "  pillarfield calibrate wires alone.h5 row.h5 column.h5 --tile-rows 40 --tile-cols 40 -o "
      "wires.h5\n");
  Group(command, "Input")
      .file("RESTING", options->files,
            "Frames of a body alone, then files with another one in its rows and in its columns");
  Group step(command, "Wires");
  constexpr auto kLeast = static_cast<std::uint64_t>(kTileSensels.low);
  constexpr auto kMost = static_cast<std::uint64_t>(kTileSensels.high);
  step.whole("--tile-rows", options->tile.rows, "N", "Sensel rows that share wires [64]", kLeast,
             kMost);
  step.whole("--tile-cols", options->tile.cols, "N", "Sensel columns that share wires [64]", kLeast,
             kMost);
  step.choice<TareOrigin>(
      "--tares", options->tares,
      {{"conduct", TareOrigin::conductance}, {"offset", TareOrigin::offset}},
      "How tares arise. conduct: unloaded sensels conduct; offset: the converter adds it [as the "
      "frames show, or else conduct]");
  add_step(command, *options, false, kCalibration);
}

void add_faults(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<FaultsCommand>(
      parent, work, calibrate, "faults",
      "Find dead, stuck and saturated sensels by parity, and mask them.",
      "  pillarfield simulate scenes/new_skin_idle.toml --uncalibrated -o idle.h5\n"
      "  pillarfield simulate scenes/new_skin_rolled.toml --uncalibrated -o rolled.h5\n"
      "  pillarfield calibrate tare idle.h5 -o tared.h5\n"
      "  pillarfield calibrate faults rolled.h5 --calibration tared.h5 -o tested.h5\n");
  Group(command, "Input")
      .file("FRAMES", options->frames, "Frames in which all of the skin is pressed");
  Group step(command, "Faults");
  FaultOptions& faults = options->faults;
  step.whole("--min-frames", faults.least_frames, "N",
             "Smallest number of frames in which parity predicts a sensel [30]", 2, 1'000'000'000);
  step.number("--still", faults.still_factor, "RATIO",
              "Largest range of a constant reading, in multiples of its noise [10]", 1e-6, 1e6);
  step.number("--moving", faults.moving_factor, "RATIO",
              "Smallest deviation of a changing prediction, in multiples of its noise [5]", 1e-6,
              1e6);
  add_step(command, *options, true, kCalibration);
}

void add_apply(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<ApplyCommand>(
      parent, work, calibrate, "apply",
      "Copy a recording with unchanged raw readings and add a calibration.",
      std::string(kIdleSkin) + "  pillarfield calibrate apply tared.h5 idle.h5 -o calibrated.h5\n");
  Group input(command, "Input");
  input.file("CALIBRATION", options->calibration, "Calibration");
  input.file("RECORDING", options->recording, "Frames to copy, as of solve");
  add_step(command, *options, false, "Recording (HDF5)", true);
}

}  // namespace

void add_calibrate(CLI::App& parent, Work& work) {
  CLI::App* const steps =
      parent.add_subcommand("calibrate", "Calibrate a skin step by step; see docs/calibration.md.");
  steps->footer(
      std::string(kPressedSkin) +
      "  pillarfield calibrate equilibrate pressed.h5 --pressure-kpa 312.5 --calibration tared.h5 "
      "-o equal.h5\n"
      "  pillarfield solve pressed.h5 --calibration equal.h5 -o forces.h5\n");
  steps->require_subcommand(1);
  add_wires(*steps, work);
  add_tare(*steps, work);
  add_equilibrate(*steps, work);
  add_load(*steps, work);
  add_shear(*steps, work);
  add_arm(*steps, work);
  add_leak(*steps, work);
  add_memory(*steps, work);
  add_bending(*steps, work);
  add_faults(*steps, work);
  add_apply(*steps, work);
  add_help(steps);
}

}  // namespace pillarfield::cli
