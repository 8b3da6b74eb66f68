#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield::cli {

/// Throws Error where the step's output cannot be written, or is one of `files` of frames or the
/// calibration that the step goes on from.
void check_step_output(const std::vector<std::string>& files, const StepOptions& options,
                       OutputKind kind);

/// Opens frames and tells their warnings on standard error.
std::unique_ptr<FrameSource> open_for_step(const std::string& file, const StepOptions& options);

/// The calibration that the options name, or a blank one for the skin of `source`; sensels that
/// are missing in `source` are masked. Throws Error where the two do not fit.
SkinCalibration calibration_before(const StepOptions& options, const FrameSource& source,
                                   const std::string& file);

/// What a step works on.
struct StepInput {
  SkinCalibration before;
  std::vector<FrameStatistics> files;
  std::uint64_t frames = 0;  ///< in all files
};

/// Checks the output, a calibration; then reads all frames of one file or more, and the calibration
/// that goes before.
StepInput read_input(const std::vector<std::string>& files, const StepOptions& options);

}  // namespace pillarfield::cli
