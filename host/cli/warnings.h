#pragma once

#include <memory>
#include <string>
#include <vector>

#include "pillarfield/recording.h"
#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints the warnings of a file to standard error, one per line.
void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings);

/// Opens frames, prints the warnings about their file and, unless `quiet`, what plain data was read
/// as.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames_with_warnings(const std::string& file,
                                                                     const ReadOptions& options,
                                                                     bool quiet);

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_with_warnings(const std::string& file);

}  // namespace pillarfield::cli
