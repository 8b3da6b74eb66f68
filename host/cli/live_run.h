#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

namespace pillarfield::cli {

using Nanoseconds = std::chrono::nanoseconds;

/// When frames come, and for how long each is worth solving.
struct LiveSchedule {
  double rate_hz = 1000;
  std::uint64_t frames = 0;
  std::uint64_t backlog_frames = 4;  ///< a frame that is late by more periods than this is dropped
  Nanoseconds spin{0};               ///< of each wait, how much is spent spinning
};

/// What became of the frames whose turn came.
struct LiveResult {
  /// From when a frame was due to when its forces were there, of the frames solved, in their order:
  /// a stall counts against every frame that it delays.
  std::vector<Nanoseconds> latencies;
  std::uint64_t dropped = 0;
  Nanoseconds elapsed{0};  ///< since the first frame was due
  bool interrupted = false;

  [[nodiscard]] std::uint64_t solved() const { return latencies.size(); }
  [[nodiscard]] std::uint64_t scheduled() const { return solved() + dropped; }
};

}  // namespace pillarfield::cli
