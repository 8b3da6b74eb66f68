#include "viewer/source/playback.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

constexpr Playback::Time kMostBehind = std::chrono::seconds(1);

/// Clamps; NaN becomes a limit.
double limited(double value, double least, double most) {
  return value > least ? std::min(value, most) : least;
}

}  // namespace

Playback::Playback(std::uint64_t frames, double rate_hz)
    : frames_(frames), rate_hz_(limited(rate_hz, 1e-3, 1e6)), shown_since_(Time::min()) {
  if (frames == 0)
    throw Error("Playback", "there are no frames", "give a source with at least one frame");
}

Playback::Time Playback::due() const {
  return first_due_ + Time(std::llround(static_cast<double>(played_) * period_ns()));
}

void Playback::show(std::uint64_t frame, Time since) {
  frame_ = frame;
  shown_since_ = since;
}

void Playback::restart(Time first_due) {
  first_due_ = first_due;
  played_ = 0;
}

void Playback::play(Time now) {
  follows_ = false;
  if (playing_) return;
  playing_ = true;
  if (!loops_ && frame_ == last() && !shown_since_) show(0, now);
  restart(now + Time(std::llround(period_ns())));
}

void Playback::pause() {
  playing_ = false;
  follows_ = false;
}

void Playback::seek(std::uint64_t frame, Time now) {
  follows_ = false;
  show(std::min(frame, last()), now);
  restart(now + Time(std::llround(period_ns())));
}

void Playback::again(Time now) { show(frame_, now); }

void Playback::step(std::int64_t frames, Time now) {
  pause();
  // Frame counts fit into a signed number.
  const auto count = static_cast<std::int64_t>(frames_);
  const auto here = static_cast<std::int64_t>(frame_);
  const std::int64_t target = loops_ ? ((here + frames % count) % count + count) % count
                                     : here + std::clamp(frames, -here, count - 1 - here);
  show(static_cast<std::uint64_t>(target), now);
}

/// Rescales the rest of the current period.
void Playback::set_speed(double speed, Time now) {
  const double before_ns = period_ns();
  const Time left = due() - now;
  speed_ = limited(speed, 0.01, 100);
  const double share = std::chrono::duration<double, std::nano>(left).count() / before_ns;
  // A late frame stays as late.
  restart(left.count() <= 0 ? now + left : now + Time(std::llround(share * period_ns())));
}

void Playback::set_loop(bool loop) { loops_ = loop; }

void Playback::set_follow(bool follow, Time now) {
  follows_ = follow;
  if (!follow) return;
  playing_ = false;
  show(last(), now);
}

void Playback::set_frames(std::uint64_t frames, Time now) {
  const std::uint64_t before = std::exchange(frames_, std::max<std::uint64_t>(frames, 1));
  if (follows_ && frames_ != before) show(last(), now);
  frame_ = std::min(frame_, last());
}

std::uint64_t Playback::give(std::uint64_t frame) {
  frame_ = frame;
  if (!loops_ && frame == last()) playing_ = false;
  return frame;
}

std::optional<std::uint64_t> Playback::next(Time now) {
  if (std::exchange(shown_since_, std::nullopt)) return give(frame_);
  if (!playing_ || now < due()) return std::nullopt;
  if (!loops_ && frame_ == last()) {  // Looping was switched off at the last frame.
    playing_ = false;
    return std::nullopt;
  }
  first_due_ += std::max(now - due() - kMostBehind, Time::zero());
  ++played_;
  return give(frame_ == last() ? 0 : frame_ + 1);
}

std::optional<Playback::Time> Playback::next_due() const {
  if (shown_since_) return shown_since_;
  if (playing_) return due();
  return std::nullopt;
}

}  // namespace pillarfield::viewer
