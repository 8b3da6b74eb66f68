#pragma once

#include <cstdint>
#include <functional>
#include <mutex>
#include <span>
#include <vector>

#include "pillarfield/scene.h"

namespace pillarfield {

/// Hysteresis and creep of the sensels of a scene: reading = V + loop + creep. Both are made of
/// many elements, so that the few of SenselMemory only approximate them.
///
/// Hysteresis: 16 plays p_j of widths r_j, evenly spread over the range R, each with weight h/4,
/// and −2h V. In a cycle from 0 to R and back both ends are exact, and at R/2 the reading is V −
/// hR/2 when loading and V + hR/2 when unloading.
///
/// Creep: after a step to V the reading rises by c·V per decade of time from 10 ms to 1000 s, in 14
/// exponentials of weight c/2, two per decade.
class MemoryHistory {
 public:
  explicit MemoryHistory(const Scene& scene);

  [[nodiscard]] static bool is_needed(const SensorModel& sensor);

  using Signal = std::function<std::vector<double>(std::uint64_t frame)>;

  /// Overwrites V of all sensels in `frame` by the readings, counts. `signal` makes V of earlier
  /// frames. Frames may come in any order: an earlier frame than the last one starts again from
  /// frame 0. Thread-safe.
  void apply(std::uint64_t frame, std::vector<double>& v, const Signal& signal);

 private:
  void restart();
  void step(std::span<const double> v);

  struct Loop {
    double width_counts;
    double weight;
  };
  struct Element {
    double update;  ///< fraction of its distance from V that the state moves in a frame
    double weight;
  };

  double linear_;  ///< weight of V itself, for the loop's ends
  std::vector<Loop> loops_;
  std::vector<Element> creep_;

  std::mutex mutex_;  ///< guards the members below
  std::uint64_t frames_ = 0;
  std::vector<float> states_;     ///< [sensel, element]: loops, then creep
  std::vector<float> previous_;   ///< V of the last frame
  std::vector<double> readings_;  ///< of the last frame
};

}  // namespace pillarfield
