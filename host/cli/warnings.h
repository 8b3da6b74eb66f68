#pragma once

#include <string>
#include <vector>

#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints what a file's reader warnings to standard error, a line each.
void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings);

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_aloud(const std::string& file);

}  // namespace pillarfield::cli
