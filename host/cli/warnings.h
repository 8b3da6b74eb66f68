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

/// Opens frames, prints the warnings about their file and, unless `quiet`, the notes.
[[nodiscard]] std::unique_ptr<FrameSource> open_frames_with_warnings(const std::string& file,
                                                                     const ReadOptions& options,
                                                                     bool quiet);

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_with_warnings(const std::string& file);

}  // namespace pillarfield::cli
