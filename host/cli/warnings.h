#pragma once

#include <string>
#include <vector>

#include "pillarfield/scene.h"

namespace pillarfield::cli {

/// Prints the warnings of a file to standard error, one per line.
void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings);

/// Loads a scene and prints its warnings.
[[nodiscard]] Scene load_scene_with_warnings(const std::string& file);

}  // namespace pillarfield::cli
