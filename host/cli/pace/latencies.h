#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <vector>

namespace pillarfield::cli {

using Nanoseconds = std::chrono::nanoseconds;

/// Outcome of the frames that were due.
struct PaceResult {
  /// Time from the due time of each solved frame to its forces, in frame order. A stall counts
  /// against every frame that it delays.
  std::vector<Nanoseconds> latencies;
  std::uint64_t dropped = 0;
  Nanoseconds elapsed{0};  ///< since the first frame was due
  bool interrupted = false;

  [[nodiscard]] std::uint64_t solved() const { return latencies.size(); }
  [[nodiscard]] std::uint64_t scheduled() const { return solved() + dropped; }
};

/// Number of frames with a latency in [from, to).
struct LatencyBin {
  Nanoseconds from;
  Nanoseconds to;
  std::uint64_t frames;
};

/// The sorted latencies of a run. A dropped frame counts as infinite latency, so that dropping slow
/// frames cannot improve a quantile.
class Latencies {
 public:
  explicit Latencies(const PaceResult& result);

  /// Returns the smallest latency that at least `fraction` (0..1) of all frames did not exceed;
  /// unset without frames and where it is that of a dropped frame.
  [[nodiscard]] std::optional<Nanoseconds> quantile(double fraction) const;

  /// Returns the largest latency of the solved frames; unset without any.
  [[nodiscard]] std::optional<Nanoseconds> largest() const;

  /// Counts the solved frames later than `deadline`.
  [[nodiscard]] std::uint64_t later_than(Nanoseconds deadline) const;

  /// Returns the solved frames in ten bins per decade, from the first to the last occupied bin. The
  /// first bin starts at 1 us and includes faster frames.
  [[nodiscard]] std::vector<LatencyBin> histogram() const;

 private:
  std::vector<Nanoseconds> sorted_;
  std::uint64_t frames_;
};

}  // namespace pillarfield::cli
