#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "cli/live_run.h"

namespace pillarfield::cli {

/// How many frames had a latency from one edge to below the other.
struct LatencyBin {
  Nanoseconds from;
  Nanoseconds to;
  std::uint64_t frames;
};

/// The latencies of a run, in order of length. A frame that was dropped counts as one whose forces
/// never came, lest a run look better for dropping its worst.
class Latencies {
 public:
  explicit Latencies(const LiveResult& result);

  /// The smallest latency that at least `share` (0..1) of all frames did not exceed; unset where
  /// that is a dropped frame's, or there was no frame.
  [[nodiscard]] std::optional<Nanoseconds> quantile(double share) const;

  /// The largest of the frames solved; unset where none was.
  [[nodiscard]] std::optional<Nanoseconds> largest() const;

  /// How many of the frames solved came later than `deadline`.
  [[nodiscard]] std::uint64_t later_than(Nanoseconds deadline) const;

  /// The frames solved in bins of ten to the decade, from one microsecond on; what is faster counts
  /// in the first bin. Runs from the first to the last bin that holds a frame.
  [[nodiscard]] std::vector<LatencyBin> histogram() const;

 private:
  std::vector<Nanoseconds> sorted_;
  std::uint64_t frames_;
};

}  // namespace pillarfield::cli
