#include "cli/calibrate/input.h"

#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

FrameStatistics statistics_of(FrameSource& source, const std::string& file,
                              const StepOptions& options, WireCorrection correct) {
  FrameStatistics statistics(file, correct.skin(), correct.type());
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  Progress progress("Reading", source.frames(), options.quiet);
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    stop_if_interrupted_before(options.output);
    source.read(index, frame);
    statistics.add(correct(frame.view()));
    progress.show(index + 1);
  }
  return statistics;
}

}  // namespace

void check_step_output(const std::vector<std::string>& files, const StepOptions& options,
                       OutputKind kind) {
  std::vector<std::filesystem::path> inputs(files.begin(), files.end());
  inputs.emplace_back(options.calibration);
  check_outputs(inputs, {{options.output, kind}}, options.replace);
}

std::unique_ptr<FrameSource> open_for_step(const std::string& file, const StepOptions& options) {
  return open_frames_with_warnings(file, options.read, options.quiet);
}

SkinCalibration initial_calibration(const StepOptions& options, const FrameSource& source,
                                    const std::string& file) {
  SkinCalibration calibration = options.calibration.empty()
                                    ? blank_calibration(source.skin())
                                    : read_calibration_file(options.calibration, options.read);
  require_fitting(calibration, source.skin(), file);
  mask_missing(calibration, source.calibration().mask);
  return calibration;
}

WireCorrection wire_correction(const FrameSource& source, const std::string& file,
                               const SkinCalibration& calibration) {
  return {file, source.skin(), source.sensel_type(), calibration.planes.effects.wires,
          calibration.planes.tare};
}

StepInput read_input(const std::vector<std::string>& files, const StepOptions& options,
                     WireUse use) {
  check_step_output(files, options, OutputKind::calibration);
  StepInput input;
  for (const std::string& file : files) {
    const std::unique_ptr<FrameSource> source = open_for_step(file, options);
    if (input.files.empty()) input.calibration = initial_calibration(options, *source, file);
    require_fitting(input.calibration, source->skin(), file);
    mask_missing(input.calibration, source->calibration().mask);
    SkinCalibration known = input.calibration;
    if (use != WireUse::loaded) known.planes.tare.clear();
    if (use == WireUse::none) known.planes.effects.wires.reset();
    input.files.push_back(
        statistics_of(*source, file, options, wire_correction(*source, file, known)));
    input.frames += source->frames();
  }
  return input;
}

}  // namespace pillarfield::cli
