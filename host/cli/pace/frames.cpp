#include "cli/pace/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::cli {
namespace {

constexpr std::uint64_t kMiB = 1U << 20U;

std::uint64_t frames_to_load(const PaceFrames& frames, std::uint64_t most,
                             std::uint64_t memory_bytes) {
  const std::uint64_t frame_bytes = frames.skin.sensels() * size_of(frames.sensel_type);
  const std::uint64_t fitting = memory_bytes / frame_bytes;
  if (fitting == 0) {
    throw Error(frames.file,
                fmt::format("a frame takes {} bytes, and {} MiB are allowed", frame_bytes,
                            memory_bytes / kMiB),
                fmt::format("give --memory-limit {}", frame_bytes / kMiB + 1));
  }
  return std::min({frames.in_source, most, fitting});
}

PaceFrames simulated(const std::string& file) {
  const auto simulator = std::make_shared<const Simulator>(load_scene(file));
  const Scene& scene = simulator->scene();
  const auto truth =
      std::make_shared<ForceField>(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  return {
      .file = file,
      .skin = scene.skin,
      .sensel_type = simulator->sensel_type(),
      .calibration = simulator->calibration(),
      .in_source = scene.frames,
      .make = [simulator, truth](std::uint64_t index,
                                 FrameBuffer& frame) { simulator->render(index, frame, *truth); },
      .loaded = {}};
}

PaceFrames recorded(const std::string& file, const ReadOptions& options) {
  const std::shared_ptr<FrameSource> source = open_frames_with_warnings(file, options, false);
  if (source->frames() == 0) {
    throw Error(file, "it has no frames", "give a recording with at least one");
  }
  return {.file = file,
          .skin = source->skin(),
          .sensel_type = source->sensel_type(),
          .calibration = source->calibration(),
          .in_source = source->frames(),
          .make = [source](std::uint64_t index, FrameBuffer& frame) { source->read(index, frame); },
          .loaded = {}};
}

}  // namespace

bool is_scene(const std::string& file) { return file.ends_with(".toml"); }

PaceFrames open_pace_frames(const std::string& file, const ReadOptions& options) {
  return is_scene(file) ? simulated(file) : recorded(file, options);
}

void load(PaceFrames& frames, std::uint64_t most, std::uint64_t memory_bytes, bool quiet) {
  const std::uint64_t count = frames_to_load(frames, most, memory_bytes);
  frames.loaded.reserve(count);
  Progress progress(is_scene(frames.file) ? "Simulating" : "Reading", count, quiet);
  for (std::uint64_t index = 0; index < count; ++index) {
    if (is_interrupted()) {
      throw Error(frames.file, "interrupted while frames were loaded", "start again");
    }
    frames.loaded.emplace_back(frames.sensel_type, frames.skin.rows, frames.skin.cols);
    frames.make(index, frames.loaded.back());
    progress.show(index + 1);
  }
}

}  // namespace pillarfield::cli
