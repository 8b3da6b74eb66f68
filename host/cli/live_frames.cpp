#include "cli/live_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "cli/interrupt.h"
#include "cli/progress.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::cli {
namespace {

constexpr std::uint64_t kMiB = 1U << 20U;

struct Bounds {
  std::string file;
  std::uint64_t most;
  std::uint64_t memory_bytes;
  bool quiet;
};

std::uint64_t frames_to_load(const LiveFrames& live, const Bounds& bounds) {
  if (live.in_source == 0) {
    throw Error(bounds.file, "it has no frames", "give a recording with one at least");
  }
  const std::uint64_t frame_bytes = live.skin.sensels() * size_of(live.sensel_type);
  const std::uint64_t fitting = bounds.memory_bytes / frame_bytes;
  if (fitting == 0) {
    throw Error(bounds.file,
                fmt::format("a frame takes {} bytes, and {} MiB are allowed", frame_bytes,
                            bounds.memory_bytes / kMiB),
                fmt::format("give --memory-limit {}", frame_bytes / kMiB + 1));
  }
  return std::min({live.in_source, bounds.most, fitting});
}

/// Fills `live.frames`; `fill(index, frame)` makes one.
template <class Fill>
void load(LiveFrames& live, const Bounds& bounds, const char* verb, const Fill& fill) {
  const std::uint64_t frames = frames_to_load(live, bounds);
  live.frames.reserve(frames);
  Progress progress(verb, frames, bounds.quiet);
  for (std::uint64_t index = 0; index < frames; ++index) {
    if (is_interrupted()) {
      throw Error(bounds.file, "interrupted before its frames were loaded", "start again");
    }
    live.frames.emplace_back(live.sensel_type, live.skin.rows, live.skin.cols);
    fill(index, live.frames.back());
    progress.show(index + 1);
  }
}

LiveFrames simulated(const Bounds& bounds) {
  const Simulator simulator(load_scene(bounds.file));
  const Skin& skin = simulator.scene().skin;
  LiveFrames live = {.skin = skin,
                     .sensel_type = simulator.sensel_type(),
                     .calibration = simulator.calibration(),
                     .frames = {},
                     .in_source = simulator.scene().frames};
  ForceField truth(skin.pillar_rows(), skin.pillar_cols());
  load(live, bounds, "Simulating",
       [&](std::uint64_t index, FrameBuffer& frame) { simulator.render(index, frame, truth); });
  return live;
}

LiveFrames recorded(const Bounds& bounds) {
  const std::unique_ptr<FrameSource> source = open_frames(bounds.file);
  for (const std::string& remark : source->remarks()) {
    fmt::print(stderr, "{}: {}\n", bounds.file, remark);
  }
  LiveFrames live = {.skin = source->skin(),
                     .sensel_type = source->sensel_type(),
                     .calibration = source->calibration(),
                     .frames = {},
                     .in_source = source->frames()};
  load(live, bounds, "Reading",
       [&](std::uint64_t index, FrameBuffer& frame) { source->read(index, frame); });
  return live;
}

}  // namespace

bool is_scene(const std::string& file) { return file.ends_with(".toml"); }

LiveFrames load_live_frames(const std::string& file, std::uint64_t most, std::uint64_t memory_bytes,
                            bool quiet) {
  const Bounds bounds = {file, most, memory_bytes, quiet};
  return is_scene(file) ? simulated(bounds) : recorded(bounds);
}

}  // namespace pillarfield::cli
