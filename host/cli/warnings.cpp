#include "cli/warnings.h"

#include <fmt/format.h>

#include "pillarfield/printable.h"

namespace pillarfield::cli {

void print_file_warnings(const std::string& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) {
    fmt::print(stderr, "{}\n", printable(fmt::format("{}: {}", file, warning)));
  }
}

std::unique_ptr<FrameSource> open_frames_with_warnings(const std::vector<std::string>& files,
                                                       const ReadOptions& options, bool quiet) {
  const std::string& file = files.front();
  std::unique_ptr<FrameSource> source =
      open_frames(std::vector<std::filesystem::path>(files.begin(), files.end()), options);
  print_file_warnings(file, source->warnings());
  const std::string read_as = source->read_as();
  if (!quiet && !read_as.empty()) print_file_warnings(file, {fmt::format("Read {}", read_as)});
  return source;
}

Scene load_scene_with_warnings(const std::string& file) {
  Scene scene = load_scene(file);
  print_file_warnings(file, scene.warnings);
  return scene;
}

}  // namespace pillarfield::cli
