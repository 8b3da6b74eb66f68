// Paced frames through a ring, with a simulated clock and solver.

#include "pipeline/paced_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pipeline/frame_loop.h"
#include "tests/pipeline/allocation_count.h"

namespace pillarfield {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using Nanoseconds = std::chrono::nanoseconds;

/// A simulated clock.
class FakeClock final : public Clock {
 public:
  Nanoseconds now() override { return time_; }
  void sleep_until(Nanoseconds time) override { time_ = std::max(time_, wake(time_, time)); }
  void advance_to(Nanoseconds time) { time_ = std::max(time_, time); }

  /// The end of a sleep from `now` until `time`.
  std::function<Nanoseconds(Nanoseconds now, Nanoseconds time)> wake =
      [](Nanoseconds, Nanoseconds time) { return time; };

 private:
  Nanoseconds time_ = seconds(1000);
};

constexpr Skin kSkin = [] {
  Skin skin;
  skin.rows = 2;
  skin.cols = 2;
  return skin;
}();

/// A stream of empty frames with given times.
class Numbers final : public FrameStream {
 public:
  explicit Numbers(std::uint64_t frames, std::vector<double> times = {})
      : frames_(frames), times_(std::move(times)) {}
  [[nodiscard]] const Skin& skin() const override { return kSkin; }
  [[nodiscard]] SenselType sensel_type() const override { return SenselType::u8; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, Nanoseconds) override {
    frame.sequence = next_;
    if (next_ == frames_) return Arrival::ended;
    frame.readings = frame.buffer.view();
    if (!times_.empty()) frame.time_s = times_.at(next_);
    ++next_;
    return Arrival::arrived;
  }

 private:
  std::uint64_t frames_;
  std::vector<double> times_;
  std::uint64_t next_ = 0;
};

/// Solves frames one after another, each in a given time, and records the calls. Allocates its
/// memory beforehand.
class FakeRing {
 public:
  FakeRing(FakeClock& clock, std::uint64_t frames, Nanoseconds each)
      : clock_(clock), durations(frames, each) {
    submitted.reserve(frames);
    submitted_at.reserve(frames);
    latencies.reserve(frames);
    done_at_.reserve(frames);
  }

  [[nodiscard]] static int capacity() { return 2; }
  [[nodiscard]] int in_flight() const { return static_cast<int>(submitted.size() - received()); }
  [[nodiscard]] StreamedFrame& vacant() { return frames_.at(submitted.size() % 2); }

  void submit() {
    ASSERT_LT(in_flight(), capacity());
    const std::uint64_t frame = vacant().sequence;
    EXPECT_EQ(vacant().readings.data, own_.at(submitted.size() % 2)) << "in another's buffer";
    submitted.push_back(frame);
    submitted_at.push_back(clock_.now());
    free_at_ = std::max(free_at_, clock_.now()) + durations.at(frame);
    done_at_.push_back(free_at_);
    most_in_flight = std::max(most_in_flight, in_flight());
  }
  void deliver() {
    ASSERT_GT(in_flight(), 0);
    clock_.advance_to(done_at_.at(received()));
    latencies.push_back(clock_.now() - frames_.at(received() % 2).arrived);
  }

 private:
  [[nodiscard]] std::size_t received() const { return latencies.size(); }

  FakeClock& clock_;
  std::array<StreamedFrame, 2> frames_ = {StreamedFrame(SenselType::u8, kSkin),
                                          StreamedFrame(SenselType::u8, kSkin)};
  std::array<const void*, 2> own_ = {frames_[0].buffer.view().data, frames_[1].buffer.view().data};

 public:
  std::vector<Nanoseconds> durations;
  std::vector<std::uint64_t> submitted;
  std::vector<Nanoseconds> submitted_at;
  std::vector<Nanoseconds> latencies;
  int most_in_flight = 0;

 private:
  Nanoseconds free_at_{0};
  std::vector<Nanoseconds> done_at_;
};

constexpr auto kNever = [] { return false; };

/// A run at 1 kHz in which each frame takes 400 microseconds by default.
class PacedStreamTest : public testing::Test {
 protected:
  static constexpr Nanoseconds kSolve = microseconds(400);
  static constexpr std::uint64_t kFrames = 100;

  PipelineStatistics run(const std::function<bool()>& stop = kNever) {
    const auto stream = paced_stream(std::make_unique<Numbers>(kFrames), pace_, clock_);
    PipelineStatistics done;
    run_frames(*stream, ring_, stop, done);
    return done;
  }
  [[nodiscard]] Nanoseconds elapsed() { return clock_->now() - start_; }

  Pace pace_ = {.rate_hz = 1000, .drop_after = milliseconds(4)};
  std::shared_ptr<FakeClock> clock_ = std::make_shared<FakeClock>();
  Nanoseconds start_ = clock_->now();
  FakeRing ring_{*clock_, kFrames, kSolve};
};

TEST_F(PacedStreamTest, SolvesEachFrameWhenItIsDue) {
  const PipelineStatistics done = run();
  EXPECT_EQ(ring_.latencies, std::vector<Nanoseconds>(100, kSolve));
  EXPECT_EQ(done.lost, 0);
  EXPECT_FALSE(done.stopped);
  EXPECT_EQ(elapsed(), milliseconds(100));
  EXPECT_EQ(ring_.most_in_flight, 1);
  for (std::uint64_t frame = 0; frame < 100; ++frame) {
    EXPECT_EQ(ring_.submitted.at(frame), frame);
    EXPECT_EQ(ring_.submitted_at.at(frame) - start_, milliseconds(frame));
  }
}

TEST_F(PacedStreamTest, FramesThatAreLateByMoreThanTheBacklogAreDroppedTheNewestKept) {
  ring_.durations[10] = milliseconds(10);
  const PipelineStatistics done = run();
  // Done at 20 ms, when frames 11 to 15 are late by 9 to 5 periods, and frame 16 by 4.
  EXPECT_EQ(done.lost, 5);
  EXPECT_EQ(ring_.latencies.size(), 95);
  EXPECT_EQ(ring_.submitted.at(10), 10);
  EXPECT_EQ(ring_.submitted.at(11), 16);
  EXPECT_EQ(ring_.latencies.at(10), milliseconds(10));
  EXPECT_EQ(ring_.latencies.at(11), microseconds(4400));
  EXPECT_EQ(ring_.latencies.at(12), microseconds(3800));
  EXPECT_EQ(ring_.latencies.back(), kSolve);
}

/// Whatever the times, no frame is lost, none comes early, and none takes less than its own time.
TEST(PacedStream, AccountsForEveryFrameOfRandomRuns) {
  constexpr std::uint64_t kFrames = 300;
  std::mt19937 random(20);
  for (int round = 0; round < 200; ++round) {
    const double rate_hz = std::uniform_real_distribution(100.0, 5000.0)(random);
    const auto due = [&](std::uint64_t frame) {
      return Nanoseconds(std::llround(static_cast<double>(frame) * 1e9 / rate_hz));
    };
    const Nanoseconds longest_wait =
        due(std::uniform_int_distribution<std::uint64_t>(0, 6)(random));
    const auto clock = std::make_shared<FakeClock>();
    clock->wake = [&](Nanoseconds, Nanoseconds time) {
      return time + microseconds(std::uniform_int_distribution(-50, 200)(random));
    };
    FakeRing ring(*clock, kFrames, Nanoseconds(0));
    for (Nanoseconds& duration : ring.durations) {
      duration = microseconds(std::geometric_distribution(1 / 300.0)(random));
    }
    const Nanoseconds start = clock->now();
    const auto stream = paced_stream(std::make_unique<Numbers>(kFrames),
                                     {.rate_hz = rate_hz, .drop_after = longest_wait}, clock);
    PipelineStatistics done;
    run_frames(*stream, ring, kNever, done);
    ASSERT_EQ(stream->health().lost, done.lost);
    ASSERT_EQ(ring.latencies.size(), ring.submitted.size());
    ASSERT_EQ(ring.submitted.size() + done.lost, kFrames);
    ASSERT_TRUE(std::ranges::is_sorted(ring.submitted));
    for (std::size_t i = 0; i < ring.submitted.size(); ++i) {
      const std::uint64_t frame = ring.submitted[i];
      const Nanoseconds late = ring.submitted_at[i] - start - due(frame);
      ASSERT_GE(late, Nanoseconds(0));
      ASSERT_LE(late, longest_wait);
      ASSERT_GE(ring.latencies[i], late + ring.durations[frame]);
    }
  }
}

TEST_F(PacedStreamTest, GoesByTheTimesOfTheFramesWhateverTheySay) {
  const std::vector<double> times = {5, 5.25, 5.25, 4, 6, std::numeric_limits<double>::lowest()};
  const auto stream = paced_stream(std::make_unique<Numbers>(times.size(), times), {}, clock_);
  PipelineStatistics done;
  run_frames(*stream, ring_, kNever, done);
  ASSERT_EQ(ring_.submitted.size(), times.size());
  const Nanoseconds last = seconds(1);
  const std::vector<Nanoseconds> due = {
      Nanoseconds(0), milliseconds(250), milliseconds(250), milliseconds(250), last, last};
  for (std::size_t i = 0; i < due.size(); ++i) {
    EXPECT_GE(ring_.submitted_at[i] - start_, due[i]);
    EXPECT_LE(ring_.submitted_at[i] - start_, due[i] + kSolve);
    EXPECT_LE(ring_.latencies[i], elapsed()) << "due before the first frame";
  }
  EXPECT_EQ(done.lost, 0);
}

TEST_F(PacedStreamTest, RefusesARateThatIsNone) {
  for (const double rate_hz : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)paced_stream(std::make_unique<Numbers>(1), {.rate_hz = rate_hz}), Error);
  }
}

TEST_F(PacedStreamTest, TakesNoMemory) {
  ring_.durations[30] = milliseconds(9);
  const auto stream = paced_stream(std::make_unique<Numbers>(kFrames), pace_, clock_);
  const std::function<bool()> never = kNever;
  PipelineStatistics done;
  const std::uint64_t before = pipeline_test::allocations();
  run_frames(*stream, ring_, never, done);
  EXPECT_EQ(pipeline_test::allocations(), before);
  EXPECT_GT(done.lost, 0);
  const auto something = std::make_unique<int>(1);
  EXPECT_EQ(pipeline_test::allocations(), before + 1) << "the count does not count";
}

}  // namespace
}  // namespace pillarfield
