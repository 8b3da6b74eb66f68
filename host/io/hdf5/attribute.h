#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Writes an attribute of one value: a 64-bit integer, a 64-bit float or a UTF-8 string of fixed
/// length. HDF5 guards fixed-length strings with a checksum; a damaged string of variable length
/// can crash it.
void write_attribute(const File& file, hid_t object, const char* name, int value);
void write_attribute(const File& file, hid_t object, const char* name, double value);
void write_attribute(const File& file, hid_t object, const char* name, const std::string& value);

/// Replaces the value of an attribute of numbers, also while frames are appended.
void rewrite_attribute(const File& file, hid_t object, const char* name, double value);

/// Writes an attribute of a list of 64-bit floats.
void write_attribute(const File& file, hid_t object, const char* name,
                     const std::vector<double>& values);

/// Reads an attribute of any standard integer, float or string type; unset if absent. Throws Error
/// if it is not a single number or string.
[[nodiscard]] std::optional<double> read_number(const File& file, hid_t object, const char* name);
[[nodiscard]] std::optional<std::string> read_text(const File& file, hid_t object,
                                                   const char* name);

/// Reads an attribute of one or several numbers, at most 65536; unset if absent.
[[nodiscard]] std::optional<std::vector<double>> read_numbers(const File& file, hid_t object,
                                                              const char* name);

}  // namespace pillarfield::hdf5
