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

}  // namespace pillarfield::viewer
