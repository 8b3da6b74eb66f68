#pragma once

#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Reads a dataset [rows, cols] of any number type.
[[nodiscard]] std::vector<float> read_plane(const File& file, const char* name, std::size_t rows,
                                            std::size_t cols);

/// Writes a dataset [rows, cols].
void write_plane(const File& file, const char* name, hid_t stored_type, hid_t memory_type,
                 std::size_t rows, std::size_t cols, const void* values);

/// Overwrites a dataset that write_plane() wrote.
void rewrite_plane(const File& file, const char* name, hid_t memory_type, const void* values);

}  // namespace pillarfield::hdf5
