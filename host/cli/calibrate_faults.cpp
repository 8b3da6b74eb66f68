// pillarfield calibrate faults: dead, stuck and saturated sensels by parity over time.

#include <fmt/format.h>

#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/fault_finder.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

FaultResult find_faults(const FaultsCommand& command) {
  check_step_output({command.frames}, command, OutputKind::calibration);
  const std::unique_ptr<FrameSource> source = open_for_step(command.frames, command);
  FaultFinder finder(command.frames, source->skin(), source->sensel_type(),
                     calibration_before(command, *source, command.frames), command.faults);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  Progress progress("Testing", source->frames(), command.quiet);
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    stop_if_interrupted_before(command.output);
    source->read(index, frame);
    finder.add(frame.view());
    progress.show(index + 1);
  }
  return finder.result();
}

void print_json(const FaultsCommand& command, const FaultResult& result) {
  nlohmann::ordered_json json = {{"output", command.output}, {"frames", result.frames}};
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
  fmt::print("Wrote {}\n", printable(command.output));
}

}  // namespace

void calibrate(const FaultsCommand& command) {
  FaultResult result = find_faults(command);
  const FaultOptions& faults = command.faults;
  result.calibration.history.push_back(
      step_done("faults", names_of({command.frames}), result.frames,
                fmt::format("least_frames = {}, still_factor = {}, moving_factor = {}",
                            faults.least_frames, faults.still_factor, faults.moving_factor)));
  write_calibration_file(command.output, result.calibration, command.replace);
  if (command.json) {
    print_json(command, result);
  } else if (!command.quiet) {
    print_text(command, result);
  }
}

}  // namespace pillarfield::cli
