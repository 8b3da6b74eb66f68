#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// True if this is an HDF5 file of a calibration; false if it cannot be read.
[[nodiscard]] bool is_calibration_file(const std::filesystem::path& path);

/// Reads a file of the format "pillarfield-calibration" version 1 (docs/formats.md). Throws Error
/// if it is of another format, is damaged, or holds values out of range.
[[nodiscard]] SkinCalibration read_calibration_file(const std::filesystem::path& path,
                                                    const ReadOptions& options = {});

/// Writes a calibration file, as `path` + ".part" until it is complete. Only Replace::anything
/// replaces an existing calibration, at the end. Throws Error if the calibration is out of range or
/// cannot be written.
void write_calibration_file(const std::filesystem::path& path, const SkinCalibration& calibration,
                            Replace replace = Replace::results);

}  // namespace pillarfield
