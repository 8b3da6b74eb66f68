#pragma once

#include <memory>
#include <string>
#include <vector>

#include "calibration/wire_correction.h"
#include "cli/commands.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield::cli {

/// Throws Error where the output cannot be written or is an input of the step.
void check_step_output(const std::vector<std::string>& files, const StepOptions& options,
                       OutputKind kind);

/// Opens frames and prints their warnings to standard error.
std::unique_ptr<FrameSource> open_for_step(const std::string& file, const StepOptions& options);

/// Returns the calibration to extend, or a blank one for the skin of `source`, and masks the
/// sensels missing in `source`. Throws Error where the two do not fit.
SkinCalibration initial_calibration(const StepOptions& options, const FrameSource& source,
                                    const std::string& file);

/// What removes the crosstalk of wires that `calibration` knows from the frames of `source`.
WireCorrection wire_correction(const FrameSource& source, const std::string& file,
                               const SkinCalibration& calibration);

/// What a step may use of the wires in the calibration that it extends.
enum class WireUse : std::uint8_t {
  loaded,    ///< crosstalk is removed
  unloaded,  ///< nothing touches the skin: tares that are an offset behind the wires stay
  none,      ///< the step finds the wires
};

struct StepInput {
  SkinCalibration calibration;
  std::vector<FrameStatistics> files;
  std::uint64_t frames = 0;  ///< in all files
};

/// Checks the output, a calibration, and reads the calibration to extend and all frames of `files`,
/// without the crosstalk of its wires.
StepInput read_input(const std::vector<std::string>& files, const StepOptions& options,
                     WireUse use = WireUse::loaded);

}  // namespace pillarfield::cli
