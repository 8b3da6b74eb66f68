#include "viewer/app/window/redraws.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

constexpr int kFramesOfInput = 3;        ///< frames that ImGui needs to react fully
constexpr double kSettlesSeconds = 1.1;  ///< rates cover the last second
constexpr double kNoticeSeconds = 6;

}  // namespace

void Redraws::input(double now_s) {
  frames_ = kFramesOfInput;
  settling_ = true;
  settled_s_ = now_s + kSettlesSeconds;
}

void Redraws::field() { frames_ = std::max(frames_, 1); }

void Redraws::notice(double now_s) { notice_ends_s_ = now_s + kNoticeSeconds; }

bool Redraws::due(double now_s) const {
  return frames_ > 0 || (settling_ && now_s >= settled_s_) || notice_is_old(now_s);
}

std::optional<double> Redraws::rest(double now_s) const {
  if (due(now_s)) return 0;
  std::optional<double> until;
  if (settling_) until = settled_s_;
  if (notice_ends_s_) until = std::min(until.value_or(*notice_ends_s_), *notice_ends_s_);
  if (!until) return std::nullopt;
  return *until - now_s;
}

void Redraws::drawn(double now_s) {
  const bool by_time = frames_ == 0;
  frames_ = std::max(frames_ - 1, 0);
  settling_ = !by_time || now_s < settled_s_;
  if (!by_time) settled_s_ = now_s + kSettlesSeconds;
}

bool Redraws::notice_is_old(double now_s) const {
  return notice_ends_s_ && now_s >= *notice_ends_s_;
}

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
