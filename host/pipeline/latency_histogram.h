#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>

namespace pillarfield {

/// Counts latencies in 100 bins per decade, from 1 microsecond to 100 s; quantiles are exact to
/// 2.4 %.
class LatencyHistogram {
 public:
  void add(std::chrono::nanoseconds latency);
  void clear() { *this = {}; }

  /// The latency in ms that at least `fraction` (0..1) of the frames did not exceed, among them
  /// `lost` ones that are later than all others; unset without frames, and for a lost one.
  [[nodiscard]] std::optional<double> quantile_ms(double fraction, std::uint64_t lost = 0) const;
  [[nodiscard]] double worst_ms() const { return worst_ms_; }

 private:
  static constexpr std::size_t kBinsPerDecade = 100;
  static constexpr std::size_t kDecades = 8;

  std::array<std::uint64_t, kBinsPerDecade * kDecades> bins_{};
  std::uint64_t frames_ = 0;
  double worst_ms_ = 0;
};

}  // namespace pillarfield
