#include "cli/remarks.h"

#include <fmt/format.h>

#include "pillarfield/printable.h"

namespace pillarfield::cli {

void print_file_remarks(const std::string& file, const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) {
    fmt::print(stderr, "{}\n", printable(fmt::format("{}: {}", file, remark)));
  }
}

Scene load_scene_aloud(const std::string& file) {
  Scene scene = load_scene(file);
  print_file_remarks(file, scene.remarks);
  return scene;
}

}  // namespace pillarfield::cli
