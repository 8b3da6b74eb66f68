#pragma once

#include <filesystem>
#include <string>

namespace pillarfield {

/// The ending of a file's name in small letters, ".csv"; empty where it has none.
[[nodiscard]] std::string ending_of(const std::filesystem::path& path);

}  // namespace pillarfield
