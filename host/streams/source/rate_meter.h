#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <numeric>

namespace pillarfield {

/// Counts events per second, over the last second in eighths.
class RateMeter {
 public:
  using Time = std::chrono::nanoseconds;

  void count(Time now) {
    advance(now);
    ++counts_[static_cast<std::size_t>(eighth_ % kKept)];
  }

  /// Events per second. Exact for a steady rate once it has lasted a second.
  [[nodiscard]] double rate_hz(Time now) {
    advance(now);
    const std::uint64_t all = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
    const std::uint64_t current = counts_[static_cast<std::size_t>(eighth_ % kKept)];
    const auto eighths = static_cast<double>(std::min(eighth_ - first_, kKept - 1));
    return eighths > 0 ? static_cast<double>(all - current) * 8 / eighths : 0;
  }

 private:
  static constexpr std::int64_t kKept = 9;  ///< eight whole ones, and the current one

  void advance(Time now) {
    const std::int64_t eighth = now / std::chrono::milliseconds(125);
    if (first_ < 0) first_ = eighth_ = eighth;
    if (eighth - eighth_ >= kKept) {
      counts_ = {};
      eighth_ = eighth;
    }
    while (eighth_ < eighth) counts_[static_cast<std::size_t>(++eighth_ % kKept)] = 0;
  }

  std::array<std::uint64_t, kKept> counts_ = {};
  std::int64_t eighth_ = 0;
  std::int64_t first_ = -1;
};

}  // namespace pillarfield
