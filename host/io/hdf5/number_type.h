#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace pillarfield::hdf5 {

/// What a type is, for messages: "uint8", "float64", "a string", "a compound".
[[nodiscard]] std::string name_of_type(hid_t type);

/// Throws Error, naming what was found, unless `type` is a standard integer of 1, 2, 4 or 8 bytes
/// or an IEEE float of 2, 4 or 8, of either byte order. HDF5 crashes while it converts some of the
/// other number types that a file can describe. `what` names the attribute or dataset.
void require_number(const std::filesystem::path& file, std::string_view what, hid_t type);

}  // namespace pillarfield::hdf5
