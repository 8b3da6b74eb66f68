// pillarfield calibrate apply: a recording with its calibration inside.

#include <fmt/format.h>

#include "cli/calibrate.h"
#include "cli/calibrate_input.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

struct ApplyCommand {
  std::string recording;
  StepOptions step;
};

/// Copies all frames, with their truth where there is one, beside other planes and constants.
void copy_frames(FrameSource& source, const ApplyCommand& command, RecordingWriter& writer) {
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  ForceField truth(source.skin().pillar_rows(), source.skin().pillar_cols());
  Progress progress("Copying", source.frames(), command.step.quiet);
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    stop_if_interrupted(index, command.step.output);
    const double time_s = source.read(index, frame);
    if (source.has_truth()) source.read_truth(index, truth);
    writer.append(frame.view(), time_s, source.has_truth() ? &truth : nullptr);
    progress.show(index + 1);
  }
}

void run(const ApplyCommand& command) {
  check_step_output({command.recording}, command.step, OutputKind::recording);
  const std::unique_ptr<FrameSource> source = open_for_step(command.recording, command.step);
  const SkinCalibration calibration =
      read_calibration_file(command.step.calibration, command.step.read);
  require_fitting(calibration, source->skin(), command.recording);
  Skin skin = source->skin();
  Calibration planes = source->calibration();
  apply(calibration, skin, planes);
  RecordingWriter writer(command.step.output, skin, source->sensel_type(), planes,
                         {.truth = source->has_truth(), .replace = command.step.replace});
  copy_frames(*source, command, writer);
  writer.finish();
  if (command.step.json) {
    const nlohmann::ordered_json json = {{"output", command.step.output},
                                         {"frames", source->frames()}};
    fmt::print("{}\n", json_text(json));
  } else {
    fmt::print("Copied {} frames, with the calibration beside them\nWrote {}\n", source->frames(),
               printable(command.step.output));
  }
}

}  // namespace

void add_calibrate_apply(CLI::App& calibrate, Work& work) {
  const auto options = std::make_shared<ApplyCommand>();
  CLI::App* const command = calibrate.add_subcommand(
      "apply", "Copy a recording, its raw readings unchanged, and put a calibration into the copy");
  command->add_option("CALIBRATION", options->step.calibration, "Calibration")->required();
  command->add_option("RECORDING", options->recording, "Recording or Tekscan export to copy")
      ->required();
  add_step_options(*command, options->step, "Recording to write (HDF5)");
  command->callback([options, &work] { work = [options] { run(*options); }; });
}

}  // namespace pillarfield::cli
