#include "cli/warnings.h"

#include <fmt/format.h>

#include "pillarfield/printable.h"

namespace pillarfield::cli {

void print_about(const std::string& file, const char* kind,
                 const std::vector<std::string>& sentences) {
  for (const std::string& sentence : sentences) {
    fmt::print(stderr, "{}\n", printable(fmt::format("{}: {}: {}", file, kind, sentence)));
  }
}

std::unique_ptr<FrameSource> open_frames_with_warnings(const std::vector<std::string>& files,
                                                       const ReadOptions& options, bool quiet) {
  const std::string& file = files.front();
  std::unique_ptr<FrameSource> source =
      open_frames(std::vector<std::filesystem::path>(files.begin(), files.end()), options);
  print_about(file, "warning", source->warnings());
  if (!quiet) print_about(file, "note", source->notes());
  return source;
}

Scene load_scene_with_warnings(const std::string& file) {
  Scene scene = load_scene(file);
  print_about(file, "warning", scene.warnings);
  return scene;
}

}  // namespace pillarfield::cli
