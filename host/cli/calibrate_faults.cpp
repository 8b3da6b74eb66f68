// pillarfield calibrate faults: dead, stuck and saturated sensels by parity over time.

#include <fmt/format.h>

#include "cli/calibrate.h"
#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/number_range.h"
#include "cli/progress.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/fault_finder.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

struct FaultsCommand {
  std::string frames;
  FaultOptions faults;
  StepOptions step;
};

FaultResult find_faults(const FaultsCommand& command) {
  check_step_output({command.frames}, command.step, OutputKind::calibration);
  const std::unique_ptr<FrameSource> source = open_for_step(command.frames, command.step);
  FaultFinder finder(command.frames, source->skin(), source->sensel_type(),
                     calibration_before(command.step, *source, command.frames), command.faults);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  Progress progress("Testing", source->frames(), command.step.quiet);
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    stop_if_interrupted_before(command.step.output);
    source->read(index, frame);
    finder.add(frame.view());
    progress.show(index + 1);
  }
  return finder.result();
}

void print_json(const FaultsCommand& command, const FaultResult& result) {
  nlohmann::ordered_json json = {{"output", command.step.output}, {"frames", result.frames}};
  add_findings(json, result.calibration, result.findings);
  json["untested"] = result.untested;
  fmt::print("{}\n", json_text(json));
}

void print_text(const FaultsCommand& command, const FaultResult& result) {
  const std::size_t sensels = std::size_t{result.calibration.rows} * result.calibration.cols;
  fmt::print("Tested {} x {} sensels with {} frames\n", result.calibration.rows,
             result.calibration.cols, result.frames);
  print_findings(result.calibration, result.findings);
  fmt::print("Untested: {} of {} sensels, which nothing asked to answer; --json lists them\n",
             result.untested.size(), sensels);
  fmt::print("Wrote {}\n", printable(command.step.output));
}

void run(const FaultsCommand& command) {
  FaultResult result = find_faults(command);
  const FaultOptions& faults = command.faults;
  result.calibration.history.push_back(
      step_done("faults", names_of({command.frames}), result.frames,
                fmt::format("least_frames = {}, still_factor = {}, moving_factor = {}",
                            faults.least_frames, faults.still_factor, faults.moving_factor)));
  write_calibration_file(command.step.output, result.calibration, command.step.replace);
  if (command.step.json) {
    print_json(command, result);
  } else {
    print_text(command, result);
  }
}

}  // namespace

void add_calibrate_faults(CLI::App& calibrate, Work& work) {
  const auto options = std::make_shared<FaultsCommand>();
  CLI::App* const command = calibrate.add_subcommand(
      "faults", "Find dead, stuck and saturated sensels by parity, and mask them");
  command->add_option("FRAMES", options->frames, "Frames in which the skin is pressed all over")
      ->required();
  add_calibration_option(*command, options->step);
  command
      ->add_option("--min-frames", options->faults.least_frames,
                   "Frames in which parity must have told of a sensel")
      ->check(whole_number_range(2, 1'000'000'000).description(""))
      ->capture_default_str();
  command
      ->add_option("--still", options->faults.still_factor,
                   "A range of so many times its noise is no movement of a reading")
      ->check(number_range(1e-6, 1e6).description(""))
      ->capture_default_str();
  command
      ->add_option("--moving", options->faults.moving_factor,
                   "A deviation of so many times its noise is one of what parity leaves")
      ->check(number_range(1e-6, 1e6).description(""))
      ->capture_default_str();
  add_step_options(*command, options->step, "Calibration to write (HDF5)");
  command->callback([options, &work] { work = [options] { run(*options); }; });
}

}  // namespace pillarfield::cli
