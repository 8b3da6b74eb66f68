#pragma once

#include <filesystem>

namespace pillarfield {

/// Names of an output while it is written and when it is complete.
struct OutputPlace {
  std::filesystem::path final_path;
  std::filesystem::path part_path;  ///< the final path and ".part"
};

/// Follows the symbolic links at `path`. Throws Error if `path` names no file, something other than
/// a regular file, or another user's link in a directory that everybody may write.
[[nodiscard]] OutputPlace place_of_output(const std::filesystem::path& path);

}  // namespace pillarfield
