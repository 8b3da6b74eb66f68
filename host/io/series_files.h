#pragma once

#include <filesystem>
#include <vector>

namespace pillarfield {

/// The files of a series: those given, and those of folders, in natural order of their names, in
/// which frame_2 comes before frame_10. Hidden files, folders within folders and metadata.yaml of a
/// ROS 2 bag are left out. Throws Error if there is none, or a folder holds several kinds of files.
[[nodiscard]] std::vector<std::filesystem::path> series_files(
    const std::vector<std::filesystem::path>& paths);

}  // namespace pillarfield
