#pragma once

#include <string>
#include <vector>

#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints what a file's reader remarks to standard error, a line each.
void print_file_remarks(const std::string& file, const std::vector<std::string>& remarks);

/// Loads a scene and prints its remarks.
[[nodiscard]] Scene load_scene_aloud(const std::string& file);

}  // namespace pillarfield::cli
