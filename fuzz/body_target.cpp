#include <fstream>

#include "fuzz/scratch_folder.h"
#include "fuzz/targets.h"
#include "pillarfield/whole_body.h"

namespace pillarfield::fuzz {

void read_body(const std::filesystem::path& path, const ReadOptions&) {
  const ScratchFolder scratch;
  std::ofstream(scratch.path() / "skin.toml") << "[skin]\npillars = [6, 8]\n";
  const std::filesystem::path body = scratch.path() / "body.toml";
  std::filesystem::copy_file(path, body);
  static_cast<void>(load_body(body));
}

}  // namespace pillarfield::fuzz
