#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/file.h"
#include "pillarfield/force_file.h"

namespace pillarfield {

/// Writes format, attributes, effects, surface and first frame of a force file; `path` is for
/// messages.
void write_info(const hdf5::File& file, const ForceFileInfo& info,
                const std::filesystem::path& path);

/// Writes the unit of the pressure, where the file has it.
void write_pressure_unit(const hdf5::File& file, const ForceFileInfo& info);

/// Reads layout and planes that a file has. Throws Error for an unknown layout.
void read_planes_of(const hdf5::File& file, ForceFileInfo& info);

/// Reads the rest of what write_info() writes; `info` has the size and layout. Adds a warning of a
/// missing pitch. Throws Error if a value is out of range.
void read_info(const hdf5::File& file, ForceFileInfo& info, std::vector<std::string>& warnings);

}  // namespace pillarfield
