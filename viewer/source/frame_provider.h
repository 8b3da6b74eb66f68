#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "pillarfield/frame.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::viewer {

/// Readings, unchanged while a copy of the handle is alive.
struct FrameHandle {
  std::shared_ptr<const FrameBuffer> readings;
  double time_s = 0;
};

/// Provides frames of readings in any order. Not thread safe.
class FrameProvider {
 public:
  virtual ~FrameProvider() = default;
  [[nodiscard]] virtual std::uint64_t frames() const = 0;

  /// At most FieldProducer::kMostShown handles may be alive. Throws Error where reading fails.
  [[nodiscard]] virtual FrameHandle frame(std::uint64_t index) = 0;

  /// See FieldProducer::refresh().
  virtual bool refresh() { return false; }
};

/// Simulates the first `frames` frames of a scene, with one thread per core. Calls `progress` from
/// this thread about 20 times a second; an exception from it stops the simulation.
[[nodiscard]] std::unique_ptr<FrameProvider> simulate_frames(
    const Simulator& simulator, std::uint64_t frames, const std::function<void(double)>& progress);

/// Reads frames of a file on demand. `source` was opened from `path` with these options.
[[nodiscard]] std::unique_ptr<FrameProvider> recorded_frames(const std::filesystem::path& path,
                                                             std::unique_ptr<FrameSource> source,
                                                             ReadOptions options);

}  // namespace pillarfield::viewer
