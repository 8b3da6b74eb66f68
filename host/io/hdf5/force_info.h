#pragma once

#include <filesystem>
#include <optional>

#include "io/hdf5/file.h"
#include "pillarfield/force_file.h"

namespace pillarfield {

/// Writes format, attributes, effects, surface and part of a force file; `path` is for messages.
void write_info(const hdf5::File& file, const ForceFileInfo& info,
                const std::filesystem::path& path);

/// Writes the unit of the pressure, where the file has it.
void write_pressure_unit(const hdf5::File& file, const ForceFileInfo& info);

/// What a part says of itself; unset for another file. Throws Error if it is incomplete or out of
/// range.
[[nodiscard]] std::optional<ForcePart> read_part(const hdf5::File& file);

}  // namespace pillarfield
