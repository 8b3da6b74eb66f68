#pragma once

#include <filesystem>
#include <string>

namespace pillarfield {

/// The extension of a file name in lower case, ".csv"; empty if it has none.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

/// Whether the extension is that of HDF5.
[[nodiscard]] bool is_hdf5_name(const std::filesystem::path& path);

}  // namespace pillarfield
