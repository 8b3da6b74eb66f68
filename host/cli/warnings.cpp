#include "cli/warnings.h"

#include <fmt/format.h>

#include "pillarfield/printable.h"

namespace pillarfield::cli {

void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    fmt::print(stderr, "{}\n", printable(fmt::format("{}: {}", file, warning)));
  }
}

Scene load_scene_with_warnings(const std::string& file) {
  Scene scene = load_scene(file);
  print_file_warnings(file, scene.warnings);
  return scene;
}

}  // namespace pillarfield::cli
