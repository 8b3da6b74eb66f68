// pillarfield calibrate apply: a recording with a calibration added.

#include <fmt/format.h>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/recording.h"

namespace pillarfield::cli {
namespace {

/// Copies all frames and their truth.
void copy_frames(FrameSource& source, const ApplyCommand& command, RecordingWriter& writer) {
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  ForceField truth(source.skin().element_rows(), source.skin().element_cols());
  Progress progress("Copying", source.frames(), command.quiet);
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    stop_if_interrupted(index, command.output);
    const double time_s = source.read(index, frame);
    if (source.has_truth()) source.read_truth(index, truth);
    writer.append(frame.view(), time_s, source.has_truth() ? &truth : nullptr);
    progress.show(index + 1);
  }
}

}  // namespace

void calibrate(const ApplyCommand& command) {
  check_outputs({command.recording, command.calibration}, {{command.output, OutputKind::recording}},
                command.replace);
  const std::unique_ptr<FrameSource> source =
      open_frames_with_warnings(command.recording, command.read, command.quiet);
  const SkinCalibration calibration = read_calibration_file(command.calibration, command.read);
  require_fitting(calibration, source->skin(), command.recording);
  Skin skin = source->skin();
  Calibration planes = source->calibration();
  apply(calibration, skin, planes);
  RecordingWriter writer(command.output, skin, source->sensel_type(), planes,
                         {.truth = source->has_truth(), .replace = command.replace});
  copy_frames(*source, command, writer);
  writer.finish();
  if (command.json) {
    const nlohmann::ordered_json json = {{"output", command.output}, {"frames", source->frames()}};
    fmt::print("{}\n", json_text(json));
  } else if (!command.quiet) {
    fmt::print("Copied {} and added the calibration\nWrote {}\n",
               counted(source->frames(), "frame"), printable(command.output));
  }
}

}  // namespace pillarfield::cli
