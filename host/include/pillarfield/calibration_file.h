#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Whether this is an HDF5 file that says it holds a calibration; false where it cannot be read.
[[nodiscard]] bool is_calibration_file(const std::filesystem::path& path,
                                       const ReadOptions& options = {});

/// Reads a file of the format "pillarfield-calibration" version 1 (docs/formats.md). Throws Error
/// where the file is none, is damaged, or holds values out of range.
[[nodiscard]] SkinCalibration read_calibration_file(const std::filesystem::path& path,
                                                    const ReadOptions& options = {});

/// Writes such a file, under `path` + ".part" until it is complete. A file that bears the name is
/// replaced only with Replace::anything, and stays good until then. Throws Error where the
/// calibration is out of range or cannot be written.
void write_calibration_file(const std::filesystem::path& path, const SkinCalibration& calibration,
                            Replace replace = Replace::results);

}  // namespace pillarfield
