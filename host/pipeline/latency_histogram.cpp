#include "pipeline/latency_histogram.h"

#include <algorithm>
#include <cmath>

namespace pillarfield {

void LatencyHistogram::add(std::chrono::nanoseconds latency) {
  const double ms = 1e-6 * static_cast<double>(latency.count());
  const double bin = std::ceil(kBinsPerDecade * std::log10(std::max(1e3 * ms, 1.0)));
  ++bins_.at(std::min(static_cast<std::size_t>(bin), bins_.size() - 1));
  ++frames_;
  worst_ms_ = std::max(worst_ms_, ms);
}

std::optional<double> LatencyHistogram::quantile_ms(double fraction, std::uint64_t lost) const {
  const double wanted = std::max(1.0, std::ceil(fraction * static_cast<double>(frames_ + lost)));
  std::uint64_t count = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    count += bins_.at(bin);
    if (static_cast<double>(count) < wanted) continue;
    const double upper = 1e-3 * std::pow(10, static_cast<double>(bin) / kBinsPerDecade);
    return std::min(upper, worst_ms_);
  }
  return std::nullopt;
}

}  // namespace pillarfield
