#pragma once

#include <vector>

#include "io/hdf5_file.h"

namespace pillarfield::hdf5 {

/// Opens a dataset, with a cache that holds one of its chunks where these are compressed.
[[nodiscard]] Handle open_dataset(const File& file, const char* name);

/// Its size in each dimension. Throws Error where it is no array.
[[nodiscard]] std::vector<hsize_t> extent_of(const File& file, const Handle& dataset,
                                             const char* name);

/// Throws Error where the file is shorter than what the dataset claims to hold: damaged headers
/// must not make anyone ask for memory, nor lost readings be taken for zeros.
void require_within_file(const File& file, const Handle& dataset, const char* name);

/// Reads a dataset [rows, cols] of any number type.
[[nodiscard]] std::vector<float> read_plane(const File& file, const char* name, std::size_t rows,
                                            std::size_t cols);

/// Writes a dataset [rows, cols].
void write_plane(const File& file, const char* name, hid_t stored_type, hid_t memory_type,
                 std::size_t rows, std::size_t cols, const void* values);

}  // namespace pillarfield::hdf5
