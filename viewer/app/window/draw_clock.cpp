#include "viewer/app/window/draw_clock.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

constexpr double kRecentSeconds = 1;

double median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return static_cast<double>(*middle);
}

}  // namespace

void DrawClock::add(double now_s, double draw_ms, std::optional<double> latency_ms) {
  Frame frame{now_s, static_cast<float>(draw_ms), std::nullopt};
  draw_ms_.push_back(frame.draw_ms);
  if (latency_ms) {
    frame.latency_ms = static_cast<float>(*latency_ms);
    latency_ms_.push_back(*frame.latency_ms);
  }
  recent_.push_back(frame);
  while (recent_.front().now_s < now_s - kRecentSeconds) recent_.pop_front();
}

DrawStatistics DrawClock::lately(double now_s) const {
  std::vector<float> draws;
  std::vector<float> latencies;
  for (const Frame& frame : recent_) {
    if (frame.now_s < now_s - kRecentSeconds) continue;
    draws.push_back(frame.draw_ms);
    if (frame.latency_ms) latencies.push_back(*frame.latency_ms);
  }
  DrawStatistics statistics;
  statistics.frames_hz = static_cast<double>(draws.size()) / kRecentSeconds;
  statistics.draw_ms_median = median(draws);
  statistics.latency_ms_median = median(latencies);
  return statistics;
}

double DrawClock::draw_ms_median() const { return median(draw_ms_); }

double DrawClock::latency_ms_median() const { return median(latency_ms_); }

}  // namespace pillarfield::viewer
