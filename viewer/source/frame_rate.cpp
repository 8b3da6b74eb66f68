#include "viewer/source/frame_rate.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pillarfield::viewer {

double frame_rate(std::uint64_t frames, const std::function<double(std::uint64_t)>& time_of) {
  constexpr double kUnknown = 100;
  constexpr std::uint64_t kMostTimes = 8;  // The time of a frame costs reading all of it.
  std::vector<double> steps;
  for (std::uint64_t index = 0; index < std::min(frames, kMostTimes); ++index) {
    const double time_s = time_of(index);
    if (index > 0) steps.back() = time_s - steps.back();
    steps.push_back(time_s);
  }
  if (steps.size() < 2) return kUnknown;
  steps.pop_back();  // Holds the last time, not a step.
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  const double rate_hz = 1 / *middle;
  return *middle > 0 && std::isfinite(rate_hz) ? rate_hz : kUnknown;
}

}  // namespace pillarfield::viewer
