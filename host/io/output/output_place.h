#pragma once

#include <filesystem>

namespace pillarfield {

/// The names that an output has while it is written and when it is complete.
struct OutputPlace {
  std::filesystem::path final_path;
  std::filesystem::path part_path;  ///< the final path and ".part"
};

/// Follows the symbolic links at `path`. Throws Error where `path` names no file, stands for
/// something other than a regular file, or for a link that may be a trap: one of another user in
/// a directory where everybody may leave files.
[[nodiscard]] OutputPlace place_of_output(const std::filesystem::path& path);

}  // namespace pillarfield
