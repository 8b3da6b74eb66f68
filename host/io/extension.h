#pragma once

#include <filesystem>
#include <string>

namespace pillarfield {

/// The extension of a file name in lower case, ".csv"; empty if it has none.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

}  // namespace pillarfield
