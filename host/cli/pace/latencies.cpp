#include "cli/pace/latencies.h"

#include <algorithm>
#include <cmath>

namespace pillarfield::cli {
namespace {

constexpr double kFirstEdgeNs = 1000;
constexpr double kBinsPerDecade = 10;

Nanoseconds edge(int bin) {
  return Nanoseconds(std::llround(kFirstEdgeNs * std::pow(10, bin / kBinsPerDecade)));
}

int bin_of(Nanoseconds latency) {
  int bin = 0;
  while (latency >= edge(bin + 1)) ++bin;
  return bin;
}

}  // namespace

Latencies::Latencies(const PaceResult& result)
    : sorted_(result.latencies), frames_(result.scheduled()) {
  std::ranges::sort(sorted_);
}

std::optional<Nanoseconds> Latencies::quantile(double fraction) const {
  constexpr double kRounding = 1e-12;  // 0.999 of 1000 frames is 999 despite binary rounding.
  const double frames = fraction * static_cast<double>(frames_) * (1 - kRounding);
  const auto rank = static_cast<std::uint64_t>(std::max(1.0, std::ceil(frames)));
  if (rank > sorted_.size()) return std::nullopt;
  return sorted_[rank - 1];
}

std::optional<Nanoseconds> Latencies::largest() const {
  if (sorted_.empty()) return std::nullopt;
  return sorted_.back();
}

std::uint64_t Latencies::later_than(Nanoseconds deadline) const {
  return static_cast<std::uint64_t>(sorted_.end() - std::ranges::upper_bound(sorted_, deadline));
}

std::vector<LatencyBin> Latencies::histogram() const {
  std::vector<LatencyBin> bins;
  if (sorted_.empty()) return bins;
  auto from = sorted_.begin();
  for (int bin = bin_of(sorted_.front()); from != sorted_.end(); ++bin) {
    const auto to = std::lower_bound(from, sorted_.end(), edge(bin + 1));
    bins.push_back({edge(bin), edge(bin + 1), static_cast<std::uint64_t>(to - from)});
    from = to;
  }
  return bins;
}

}  // namespace pillarfield::cli
