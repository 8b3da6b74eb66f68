#pragma once

#include <cstdint>
#include <filesystem>

#include "io/hdf5/file.h"
#include "pillarfield/force_file.h"

namespace pillarfield {

/// Writes format, attributes, effects, surface and first frame of a force file; `path` is for
/// messages.
void write_info(const hdf5::File& file, const ForceFileInfo& info,
                const std::filesystem::path& path);

/// Writes the unit of the pressure, where the file has it.
void write_pressure_unit(const hdf5::File& file, const ForceFileInfo& info);

/// Number of the first frame in its source. Throws Error if it is out of range.
[[nodiscard]] std::uint64_t read_first_frame(const hdf5::File& file);

}  // namespace pillarfield
