#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "pillarfield/frame.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

namespace pillarfield::viewer {

/// Readings that stay as they are while a copy of this is alive.
struct FrameHandle {
  std::shared_ptr<const FrameBuffer> readings;
  double time_s = 0;
};

/// Frames of readings in any order. For one thread.
class FrameProvider {
 public:
  virtual ~FrameProvider() = default;
  [[nodiscard]] virtual std::uint64_t frames() const = 0;

  /// Throws Error where it cannot be read. At most FieldProducer::kMostShown may be alive.
  [[nodiscard]] virtual FrameHandle frame(std::uint64_t index) = 0;

  /// As FieldProducer's.
  virtual bool refresh() { return false; }
};

/// The first `frames` frames of a scene, simulated now, by as many threads as there are cores.
/// `progress` is called from this thread, about twenty times a second; what it throws stops the
/// simulation.
[[nodiscard]] std::unique_ptr<FrameProvider> simulate_frames(
    const Simulator& simulator, std::uint64_t frames, const std::function<void(double)>& progress);

/// Frames of a file, read when they are asked for. `path` is what `source` was opened from.
[[nodiscard]] std::unique_ptr<FrameProvider> recorded_frames(const std::filesystem::path& path,
                                                             std::unique_ptr<FrameSource> source);

}  // namespace pillarfield::viewer
