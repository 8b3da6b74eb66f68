#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// Throws Error where an output of `kind` may not replace the file at `path`, if there is one.
void require_replaceable(const std::filesystem::path& path, OutputKind kind, Replace replace);

/// Throws Error where the part that an earlier writer left at `path` holds what cannot be made
/// again: frames of a recording, a calibration, or an HDF5 file of another program.
void require_worthless(const std::filesystem::path& path);

}  // namespace pillarfield
