// The options of the calibration steps and their help, from the table of the steps.

#include "cli/options/shared_arguments.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

/// Adds the arguments of all steps.
void add_step_options(CLI::App* command, StepOptions& options, const char* output,
                      bool uses_times) {
  add_trust(command, options.read);
  add_plain_data(command, options.read, true);
  options.read.untimed = !uses_times;
  add_output(command, options, output);
  add_general(command, options, "Print the summary as JSON", kQuietWriter);
}

std::string examples_of(const std::vector<const char*>& commands) {
  std::string text;
  for (const char* const command : commands) text += fmt::format("  pillarfield {}\n", command);
  return text;
}

CLI::Option* add_value(Group& group, const StepArgument& argument, StepCommand& options) {
  const std::string name = fmt::format("--{}", argument.name);
  StepValues& values = options.values;
  const auto& [low, high, open_low, open_high] = argument.range;
  switch (argument.kind) {
    case StepArgument::Kind::flag:
      return group.flag_callback(
          name, [&] { values.numbers[argument.name] = {1}; }, argument.help);
    case StepArgument::Kind::word:
      return group.word(name, values.words[argument.name], argument.words, argument.help);
    case StepArgument::Kind::log:
      return group.text(name, options.logs, argument.unit, argument.help);
    case StepArgument::Kind::whole:
      return group.whole(name, values.numbers[argument.name], argument.unit, argument.help,
                         static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(high));
    case StepArgument::Kind::number:
      break;
  }
  return group.number(name, values.numbers[argument.name], argument.unit, argument.help, low, high);
}

void add_values(CLI::App* command, const StepKind& step, StepCommand& options) {
  Group group(command, "Step");
  for (const StepArgument& argument : step.arguments) {
    CLI::Option* const option = add_value(group, argument, options);
    option->required(argument.required);
    if (argument.count_per_file > 0) {
      option->delimiter(',')->allow_extra_args(false);
    } else if (argument.kind != StepArgument::Kind::flag) {
      option->expected(1);
    }
  }
}

void add_calibration_step(CLI::App& parent, Work& work, const StepKind& step) {
  const auto [command, options] = add_command<StepCommand>(
      parent, work, calibrate, step.name, step.summary, examples_of(step.examples));
  options->step = &step;
  Group input(command, "Input");
  input.text(step.frames, options->files, "FILE", step.frames_help)
      ->required()
      ->expected(1, step.is_single ? 1 : CLI::detail::expected_max_vector_size);
  if (step.before != StepKind::Before::none) {
    input.text("--calibration", options->calibration, "FILE", step.before_help)
        ->required(step.before == StepKind::Before::required);
  }
  add_values(command, step, *options);
  add_step_options(command, *options, "Calibration (HDF5)", step.uses_times);
  command->parse_complete_callback([options = options] {
    try {
      check(*options->step, options->values, options->files.size(), options->logs.size());
    } catch (const Error& error) {
      throw CLI::ValidationError(error.what());
    }
  });
}

void add_apply(CLI::App& parent, Work& work) {
  const auto [command, options] = add_command<ApplyCommand>(
      parent, work, calibrate, "apply",
      "Copy a recording with unchanged raw readings and add a calibration.",
      examples_of({kSimulateIdle, kTareIdle, "calibrate apply tared.h5 idle.h5 -o calibrated.h5"}));
  Group input(command, "Input");
  input.file("CALIBRATION", options->calibration, "Calibration");
  input.file("RECORDING", options->recording, "Frames to copy, as of solve");
  add_step_options(command, *options, "Recording (HDF5)", true);
}

}  // namespace

void add_calibrate(CLI::App& parent, Work& work) {
  CLI::App* const steps =
      parent.add_subcommand("calibrate", "Calibrate a skin step by step; see docs/calibration.md.");
  steps->footer(examples_of({kSimulateIdle, kSimulatePressed, kTareIdle, kEquilibratePressed,
                             "solve pressed.h5 --calibration equal.h5 -o forces.h5"}));
  steps->require_subcommand(1);
  for (const StepKind& step : calibration_steps()) add_calibration_step(*steps, work, step);
  add_apply(*steps, work);
  add_help(steps);
}

}  // namespace pillarfield::cli
