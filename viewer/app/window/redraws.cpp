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

RecentTimes::Time time_of(double now_s) {
  return std::chrono::duration_cast<RecentTimes::Time>(std::chrono::duration<double>(now_s));
}

}  // namespace

void DrawClock::add(double now_s, double draw_ms, std::optional<double> latency_ms) {
  draws_.add(time_of(now_s), draw_ms);
  draw_ms_.push_back(draw_ms);
  if (!latency_ms) return;
  latencies_.add(time_of(now_s), *latency_ms);
  latency_ms_.push_back(*latency_ms);
}

DrawStatistics DrawClock::lately(double now_s) const {
  draws_.forget_before(time_of(now_s));
  latencies_.forget_before(time_of(now_s));
  DrawStatistics statistics;
  statistics.frames_hz = draws_.rate_hz();
  statistics.draw_ms_median = draws_.median_ms();
  statistics.latency_ms_median = latencies_.median_ms();
  return statistics;
}

}  // namespace pillarfield::viewer
