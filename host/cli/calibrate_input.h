#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/output_file.h"
#include "pillarfield/recording.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield::cli {

/// What every step of a calibration is told.
struct StepOptions {
  std::string calibration;  ///< file to go on from; empty where there is none
  std::string output;
  Replace replace = Replace::results;
  ReadOptions read;
  bool json = false;
  bool quiet = false;
};

/// --output, --overwrite, --trust-input, --json and --quiet; `wrote` says what the output is.
void add_step_options(CLI::App& command, StepOptions& options, const char* wrote);

/// --calibration, which is needed.
void add_calibration_option(CLI::App& command, StepOptions& options);

/// Throws Error where the step's output cannot be written, or is one of `files` of frames or the
/// calibration that the step goes on from.
void check_step_output(const std::vector<std::string>& files, const StepOptions& options,
                       OutputKind kind);

/// Opens frames and tells their remarks on standard error.
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

/// Throws the error of a wrong command line unless there is a value of `option` for each file.
void require_one_each(const char* option, const std::vector<std::string>& files,
                      const std::vector<double>& values);

/// The names of files without their folders, as they are kept in a history.
std::vector<std::string> names_of(const std::vector<std::string>& files);

}  // namespace pillarfield::cli
