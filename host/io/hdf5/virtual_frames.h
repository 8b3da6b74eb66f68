#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Frames of a virtual dataset that lie in another file, from its first frame on.
struct VirtualPart {
  std::filesystem::path file;  ///< from the folder of the virtual dataset's file
  std::uint64_t first = 0;
  std::uint64_t frames = 0;
};

/// Creates a virtual dataset [frames, rows, cols] over datasets of the same name. Frames that no
/// part holds, or whose file is absent, read as `fill`, a value of `stored_type`.
void create_virtual_frames(const File& file, const char* name, hid_t stored_type,
                           const std::vector<hsize_t>& extent,
                           const std::vector<VirtualPart>& parts, const void* fill);

/// Creates a dataset [frames] of doubles.
void write_numbers(const File& file, const char* name, const std::vector<double>& values);

}  // namespace pillarfield::hdf5
