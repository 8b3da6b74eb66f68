#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// Throws Error if a file exists at `path` that an output of `kind` may not replace.
void require_replaceable(const std::filesystem::path& path, OutputKind kind, Replace replace);

/// Throws Error if the part that an earlier writer left at `path` holds data that cannot be made
/// again: frames of a recording, a calibration, or an HDF5 file of another program.
void require_disposable(const std::filesystem::path& path);

}  // namespace pillarfield
