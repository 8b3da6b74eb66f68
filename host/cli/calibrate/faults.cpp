// pillarfield calibrate faults: dead, stuck and saturated sensels by parity over time.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/interrupt.h"
#include "cli/number_text.h"
#include "cli/progress.h"

namespace pillarfield::cli {
namespace {

FaultResult find_faults(const FaultsCommand& command) {
  check_step_output({command.frames}, command, OutputKind::calibration);
  const std::unique_ptr<FrameSource> source = open_for_step(command.frames, command);
  const SkinCalibration before = initial_calibration(command, *source, command.frames);
  WireCorrection correct = wire_correction(*source, command.frames, before);
  FaultFinder finder(command.frames, correct.skin(), correct.type(), before, command.faults);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  Progress progress("Testing", source->frames(), command.quiet);
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    stop_if_interrupted_before(command.output);
    source->read(index, frame);
    finder.add(correct(frame.view()));
    progress.show(index + 1);
  }
  return finder.result();
}

}  // namespace

void calibrate(const FaultsCommand& command) {
  const FaultResult result = find_faults(command);
  const SkinCalibration& calibration = result.calibration;
  const FaultOptions& faults = command.faults;
  finish_step(
      command, calibration, "faults", {command.frames}, result.frames,
      fmt::format("least_frames = {}, still_factor = {}, moving_factor = {}", faults.least_frames,
                  faults.still_factor, faults.moving_factor),
      {.headline = fmt::format("Tested {} x {} sensels with {}", calibration.rows, calibration.cols,
                               counted(result.frames, "frame")),
       .facts = {},
       .findings = &result.findings,
       .more = {{"untested", result.untested}},
       .lines = {fmt::format("Untested: {} of {} sensels, never predicted to change; --json lists "
                             "them",
                             grouped(result.untested.size()),
                             grouped(std::size_t{calibration.rows} * calibration.cols))}});
}

}  // namespace pillarfield::cli
