#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace pillarfield::hdf5 {

/// Name of a type for messages: "uint8", "float64", "a string", "a compound".
[[nodiscard]] std::string name_of_type(hid_t type);

/// Throws Error, naming the type, unless `type` is a standard integer of 1, 2, 4 or 8 bytes or an
/// IEEE float of 2, 4 or 8, in either byte order. HDF5 crashes when it converts some other number
/// types. `what` names the attribute or dataset.
void require_number(const std::filesystem::path& file, std::string_view what, hid_t type);

}  // namespace pillarfield::hdf5
