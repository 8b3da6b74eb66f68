#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"

namespace pillarfield {

/// Throws Error if a file exists at `path` that an output of `kind` may not replace.
void require_replaceable(const std::filesystem::path& path, OutputKind kind, Replace replace);

/// Throws Error if the part that an earlier writer left at `path` holds data that cannot be made
/// again: an HDF5 file or frames of another program, or, unless `replace` is Replace::anything, a
/// calibration, messages or frames of a recording.
void require_disposable(const std::filesystem::path& path, Replace replace);

}  // namespace pillarfield
