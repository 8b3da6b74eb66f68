#pragma once

#include <optional>
#include <string>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Attributes of one value. Those written are 64-bit integers, 64-bit floats and UTF-8 strings of
/// fixed length, which HDF5 guards with a checksum (strings of variable length it does not, and a
/// damaged one can crash it). Those read may be of any standard integer, float or string type.
void write_attribute(const File& file, hid_t object, const char* name, int value);
void write_attribute(const File& file, hid_t object, const char* name, double value);
void write_attribute(const File& file, hid_t object, const char* name, const std::string& value);

/// Unset where the attribute is absent. Throws Error where it is no single number or string. A
/// damaged string of variable length can crash HDF5: probe_file() comes first.
[[nodiscard]] std::optional<double> read_number(const File& file, hid_t object, const char* name);
[[nodiscard]] std::optional<std::string> read_text(const File& file, hid_t object,
                                                   const char* name);

}  // namespace pillarfield::hdf5
