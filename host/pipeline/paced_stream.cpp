#include "pipeline/paced_stream.h"

#include <fmt/format.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

using std::chrono::nanoseconds;

class MonotonicClock final : public Clock {
 public:
  /// Disables timer slack, by which Linux delays wake-ups of a thread by up to 50 microseconds.
  MonotonicClock() { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

  [[nodiscard]] nanoseconds now() override {
    return std::chrono::steady_clock::now().time_since_epoch();
  }

  /// Returns early on a signal.
  void sleep_until(nanoseconds time) override {
    const auto whole = std::chrono::duration_cast<std::chrono::seconds>(time);
    const timespec until = {.tv_sec = whole.count(), .tv_nsec = (time - whole).count()};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
};

class PacedStream final : public FrameStream {
 public:
  PacedStream(std::unique_ptr<FrameStream> stream, const Pace& pace, std::shared_ptr<Clock> clock)
      : stream_(std::move(stream)),
        pace_(pace),
        clock_(std::move(clock)),
        ahead_(stream_->sensel_type(), stream_->skin()) {
    if (!pace.rate_hz || (std::isfinite(*pace.rate_hz) && *pace.rate_hz > 0)) return;
    throw Error("pace", fmt::format("rate_hz is {}", *pace.rate_hz), "it must be above zero");
  }

  [[nodiscard]] const Skin& skin() const override { return stream_->skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return stream_->sensel_type(); }
  [[nodiscard]] const Calibration& calibration() const override { return stream_->calibration(); }
  [[nodiscard]] StreamHealth health() const override;
  [[nodiscard]] Arrival next(StreamedFrame& frame, nanoseconds timeout) override;

 private:
  [[nodiscard]] nanoseconds due_ahead() const;
  void sleep(nanoseconds now, nanoseconds timeout);

  std::unique_ptr<FrameStream> stream_;
  Pace pace_;
  std::shared_ptr<Clock> clock_;
  StreamedFrame ahead_;                    ///< the next frame, read before it is due
  Arrival ahead_is_ = Arrival::timed_out;  ///< state of `ahead_`
  nanoseconds due_{0};                     ///< time at which `ahead_` is due
  std::optional<nanoseconds> start_;       ///< time of the first frame
  std::uint64_t first_sequence_ = 0;
  double first_time_s_ = 0;
  std::uint64_t dropped_ = 0;
};

/// A dropped frame counts as a sensor's that came faster than the program read them.
StreamHealth PacedStream::health() const {
  StreamHealth health = stream_->health();
  health.lost += dropped_;
  health.overrun += dropped_;
  return health;
}

/// Time at which `ahead_` is due. At the end of a stream without a rate it is an earlier frame,
/// whose time has passed.
nanoseconds PacedStream::due_ahead() const {
  constexpr double kLongest = 1e9;  // seconds; a sensor's clock may return any time
  if (!pace_.rate_hz) {
    const double after_s = std::clamp(ahead_.time_s - first_time_s_, 0.0, kLongest);
    return *start_ + nanoseconds(std::llround(after_s * 1e9));
  }
  const auto frames = static_cast<double>(ahead_.sequence - first_sequence_);
  return *start_ + nanoseconds(std::llround(std::min(frames * 1e9 / *pace_.rate_hz, 1e18)));
}

void PacedStream::sleep(nanoseconds now, nanoseconds timeout) {
  const nanoseconds until = std::min(due_, now + timeout);
  if (now < until) clock_->sleep_until(until);
}

Arrival PacedStream::next(StreamedFrame& frame, nanoseconds timeout) {
  const nanoseconds begun = clock_->now();
  for (bool slept = false;;) {
    if (ahead_is_ == Arrival::timed_out) {
      // It is read into the caller's buffer, which the next call returns.
      ahead_is_ = stream_->next(frame, timeout);
      if (ahead_is_ == Arrival::timed_out) return ahead_is_;
      std::swap(frame, ahead_);
      if (!start_) {
        start_ = clock_->now();
        first_sequence_ = ahead_.sequence;
        first_time_s_ = ahead_.time_s;
      }
      due_ = due_ahead();
    }
    frame.sequence = ahead_.sequence;
    const nanoseconds now = clock_->now();
    if (now < due_) {
      if (slept) return Arrival::timed_out;
      sleep(now, timeout);
      slept = true;
    } else if (ahead_is_ == Arrival::ended) {
      return Arrival::ended;
    } else {
      ahead_is_ = Arrival::timed_out;
      std::swap(frame, ahead_);
      if (pace_.drop_after && now - due_ > *pace_.drop_after) {
        ++dropped_;
        // All are dropped if reading takes longer than a period: let the caller look around.
        if (now - begun > timeout) return Arrival::timed_out;
        continue;
      }
      frame.arrived = due_;
      return Arrival::arrived;
    }
  }
}

}  // namespace

std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream, const Pace& pace,
                                          std::shared_ptr<Clock> clock) {
  return std::make_unique<PacedStream>(std::move(stream), pace, std::move(clock));
}

std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream, const Pace& pace) {
  return paced_stream(std::move(stream), pace, std::make_shared<MonotonicClock>());
}

}  // namespace pillarfield
