#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pillarfield/recording.h"
#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints sentences about a file to standard error, one per line, each after "warning" or "note".
void print_about(const std::string& file, const char* kind,
                 const std::vector<std::string>& sentences);

/// Opens frames of files and folders, prints the warnings about them and, unless `quiet`, the
/// notes.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames_with_warnings(
    const std::vector<std::string>& files, const ReadOptions& options, bool quiet);

[[nodiscard]] inline std::unique_ptr<FrameSource> open_frames_with_warnings(
    const std::string& file, const ReadOptions& options, bool quiet) {
  return open_frames_with_warnings(std::vector{file}, options, quiet);
}

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_with_warnings(const std::string& file);

}  // namespace pillarfield::cli
