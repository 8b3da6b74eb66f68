#include "fuzz/some_frames.h"
#include "fuzz/targets.h"
#include "pillarfield/comparison.h"
#include "pillarfield/force_file.h"

namespace pillarfield::fuzz {

void read_forces(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  (void)is_force_file(path, options);
  const ForceFileReader reader(path, options);
  const ForceFileInfo& info = reader.info();
  if (std::uint64_t{info.rows} * info.cols > kMaxRead) return;
  ForceField forces(info.rows, info.cols);
  Comparison comparison;
  for (const std::uint64_t index : some_frames(reader.frames())) {
    reader.read(index, forces);
    if (info.contacts) (void)reader.read_contacts(index);
    comparison.add(forces.view(), forces.view());
  }
}

}  // namespace pillarfield::fuzz
