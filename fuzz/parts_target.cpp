#include <algorithm>
#include <vector>

#include "fuzz/scratch_folder.h"
#include "fuzz/some_frames.h"
#include "fuzz/targets.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"

namespace pillarfield::fuzz {
namespace {

/// Largest parts that are written beside the file that is read.
constexpr std::uint64_t kMostParts = 4;
constexpr std::uint64_t kMostFrames = 64;

/// Writes a part without contact, of the size that `info` gives, with times from `first_time_s` on.
void write_part(const std::filesystem::path& output, ForceFileInfo info, const ForcePart& part,
                double first_time_s) {
  info.part = part;
  ForceField forces(info.rows, info.cols);
  const std::vector<float> zeros(forces.elements());
  ForceFieldView view = forces.view();
  for (auto* plane : {&view.magnitude, &view.theta, &view.phi}) *plane = zeros;
  std::ranges::fill(view.uncertainty, zeros);
  const FrameContacts contacts;
  const auto sink = create_force_sink(part_file(output, part.index), info, Replace::anything);
  const FrameRange frames = frames_of(part);
  for (std::uint64_t frame = frames.first; frame < frames.end; ++frame) {
    sink->append({.forces = view,
                  .contacts = info.contacts ? &contacts : nullptr,
                  .time_s = first_time_s + 1e-9 * static_cast<double>(frame),
                  .sequence = frame});
  }
  sink->finish();
}

/// Writes all parts that are small, but for `except`.
void write_parts(const std::filesystem::path& output, const ForceFileInfo& info, ForcePart part,
                 std::uint64_t except) {
  if (part.count > kMostParts || part.frames > kMostFrames ||
      std::uint64_t{info.rows} * info.cols > kMaxSolved) {
    return;
  }
  for (part.index = 1; part.index <= part.count; ++part.index) {
    // Parts after `except` begin later than any of its times.
    if (part.index != except) write_part(output, info, part, part.index < except ? -1e6 : 1e6);
  }
}

/// Copies a file beside others.
void place(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::filesystem::create_directory(to.parent_path());
  std::filesystem::copy_file(from, to);
}

}  // namespace

void read_parts(const std::filesystem::path& path, const ReadOptions& options) {
  const ForceFileReader file(path, options);
  const ForceFileInfo& info = file.info();
  if (std::uint64_t{info.rows} * info.cols > kMaxRead) return;
  const ScratchFolder scratch;
  const std::filesystem::path output = scratch.path() / "out.h5";
  if (!info.part) throw Error(path.string(), "is not a part");
  place(path, part_file(output, info.part->index));
  write_parts(output, info, *info.part, info.part->index);
  static_cast<void>(join_parts(output, {.read = options}));
  read_forces(output, options);
}

}  // namespace pillarfield::fuzz
