#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pillarfield/recording.h"
#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints the warnings of a file to standard error, one per line.
void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings);

/// Opens frames of files and folders, prints the warnings about their file and, unless `quiet`,
/// what plain data was read as.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames_with_warnings(
    const std::vector<std::string>& files, const ReadOptions& options, bool quiet);

[[nodiscard]] inline std::unique_ptr<FrameSource> open_frames_with_warnings(
    const std::string& file, const ReadOptions& options, bool quiet) {
  return open_frames_with_warnings(std::vector{file}, options, quiet);
}

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_with_warnings(const std::string& file);

}  // namespace pillarfield::cli
