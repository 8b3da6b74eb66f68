#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <vector>

namespace pillarfield::cli {

using Nanoseconds = std::chrono::nanoseconds;

/// When frames come, and for how long each is worth solving.
struct LiveSchedule {
  double rate_hz = 1000;
  std::uint64_t frames = 0;
  std::uint64_t backlog_frames = 4;  ///< a frame that is late by more periods than this is dropped
  Nanoseconds spin{0};               ///< of each wait, how much is spent spinning

  /// When frame `index` comes, after the first.
  [[nodiscard]] Nanoseconds due(std::uint64_t index) const {
    return Nanoseconds(std::llround(static_cast<double>(index) * 1e9 / rate_hz));
  }
};

/// What became of the frames whose turn came.
struct LiveResult {
  /// From when a frame was due to when its forces were there, of the frames solved, in their order:
  /// a stall counts against every frame that it delays.
  std::vector<Nanoseconds> latencies;
  std::uint64_t dropped = 0;
  Nanoseconds elapsed{0};  ///< since the first frame was due
  bool interrupted = false;

  [[nodiscard]] std::uint64_t solved() const { return latencies.size(); }
  [[nodiscard]] std::uint64_t scheduled() const { return solved() + dropped; }
};

/// Sends frames through a pipeline at a fixed rate, each when it is due or, while the pipeline is
/// late, as soon as there is room; only then is more than one frame in flight. All memory is taken
/// by the constructor; run() takes none, waits for no lock and writes nothing.
///
/// Clock: `Nanoseconds now()`, and `sleep_until(Nanoseconds)`, which may return early.
/// Pipeline: `int capacity()`, at most kMaxInFlight; `int in_flight()`; `submit(std::uint64_t
/// frame)`; and `receive()`, which waits for the oldest frame in flight.
class LiveRun {
 public:
  static constexpr std::size_t kMaxInFlight = 64;

  explicit LiveRun(const LiveSchedule& schedule)
      : schedule_(schedule),
        end_(schedule.frames),
        longest_wait_(schedule.due(schedule.backlog_frames)) {
    result_.latencies.resize(schedule.frames);  // Touches the pages.
    result_.latencies.clear();
  }

  /// Once. Ends early when `stop()` becomes true, with the frames in flight received.
  template <class Clock, class Pipeline, class Stop>
  void run(Clock& clock, Pipeline& pipeline, const Stop& stop) {
    start_ = clock.now();
    while (goes_on(stop) || pipeline.in_flight() > 0) {
      if (next_ < end_ && take_next(clock, pipeline)) continue;
      if (pipeline.in_flight() > 0) {
        pipeline.receive();
        result_.latencies.push_back(clock.now() - due_in_flight_.at(received_++ % kMaxInFlight));
      } else {
        wait(clock, due(next_));
      }
    }
    // The last frame has a period of its own, as all others.
    while (!result_.interrupted && clock.now() < due(end_) && !stop()) wait(clock, due(end_));
    result_.elapsed = clock.now() - start_;
  }

  [[nodiscard]] const LiveResult& result() const { return result_; }

 private:
  [[nodiscard]] Nanoseconds due(std::uint64_t index) const { return start_ + schedule_.due(index); }

  template <class Stop>
  bool goes_on(const Stop& stop) {
    if (next_ < end_ && stop()) {
      result_.interrupted = true;
      end_ = next_;
    }
    return next_ < end_;
  }

  /// Submits or drops the next frame; false where it is too early for either.
  template <class Clock, class Pipeline>
  bool take_next(Clock& clock, Pipeline& pipeline) {
    const Nanoseconds late = clock.now() - due(next_);
    if (late > longest_wait_) {
      ++result_.dropped;
    } else if (late >= Nanoseconds(0) && pipeline.in_flight() < pipeline.capacity()) {
      due_in_flight_.at(submitted_++ % kMaxInFlight) = due(next_);
      pipeline.submit(next_);
    } else {
      return false;
    }
    ++next_;
    return true;
  }

  template <class Clock>
  void wait(Clock& clock, Nanoseconds until) {
    if (clock.now() < until - schedule_.spin) clock.sleep_until(until - schedule_.spin);
    // What is left is spun away by those who call this again.
  }

  LiveSchedule schedule_;
  Nanoseconds start_{0};
  std::uint64_t next_ = 0;  ///< frame whose turn comes next
  std::uint64_t end_;       ///< frame after the last
  Nanoseconds longest_wait_;
  std::array<Nanoseconds, kMaxInFlight> due_in_flight_{};
  std::uint64_t submitted_ = 0;
  std::uint64_t received_ = 0;
  LiveResult result_;
};

}  // namespace pillarfield::cli
