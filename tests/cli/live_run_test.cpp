// The pacing of a live run, with a clock and a pipeline of which every moment is known.

#include "cli/live_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include "tests/cli/allocation_count.h"

namespace pillarfield::cli {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

/// A clock that moves when it is told to.
class FakeClock {
 public:
  Nanoseconds now() {
    time_ += tick;
    return time_;
  }
  void sleep_until(Nanoseconds time) {
    ++sleeps;
    time_ = std::max(time_, wake(time_, time));
  }
  void advance_to(Nanoseconds time) { time_ = std::max(time_, time); }

  /// When a sleep from `now` until `time` ends.
  std::function<Nanoseconds(Nanoseconds now, Nanoseconds time)> wake =
      [](Nanoseconds, Nanoseconds time) { return time; };
  Nanoseconds tick{0};  ///< that passes with every look at the clock
  int sleeps = 0;

 private:
  Nanoseconds time_ = seconds(1000);
};

/// Solves one frame after the other, each in the time it is given, and notes what it is asked.
/// Memory is taken beforehand.
class FakePipeline {
 public:
  FakePipeline(FakeClock& clock, std::uint64_t frames, Nanoseconds each)
      : clock_(clock), durations(frames, each) {
    submitted.reserve(frames);
    submitted_at.reserve(frames);
    done_at_.reserve(frames);
  }

  [[nodiscard]] static int capacity() { return 2; }
  [[nodiscard]] int in_flight() const { return static_cast<int>(submitted.size() - received); }

  void submit(std::uint64_t frame) {
    ASSERT_LT(in_flight(), capacity());
    submitted.push_back(frame);
    submitted_at.push_back(clock_.now());
    free_at_ = std::max(free_at_, clock_.now()) + durations.at(frame);
    done_at_.push_back(free_at_);
    most_in_flight = std::max(most_in_flight, in_flight());
  }
  void receive() {
    ASSERT_GT(in_flight(), 0);
    clock_.advance_to(done_at_.at(received++));
  }

 private:
  FakeClock& clock_;

 public:
  std::vector<Nanoseconds> durations;
  std::vector<std::uint64_t> submitted;
  std::vector<Nanoseconds> submitted_at;
  std::size_t received = 0;
  int most_in_flight = 0;

 private:
  Nanoseconds free_at_{0};
  std::vector<Nanoseconds> done_at_;
};

constexpr auto kNever = [] { return false; };

/// A run of 1 kHz, each frame taking 400 microseconds unless a test says otherwise.
class LiveRunTest : public testing::Test {
 protected:
  static constexpr Nanoseconds kSolve = microseconds(400);

  explicit LiveRunTest(std::uint64_t frames = 100)
      : schedule_{.rate_hz = 1000, .frames = frames, .backlog_frames = 4},
        pipeline_(clock_, frames, kSolve) {}

  template <class Stop>
  LiveResult run(const Stop& stop) {
    LiveRun run(schedule_);
    run.run(clock_, pipeline_, stop);
    return run.result();
  }
  LiveResult run() { return run(kNever); }

  LiveSchedule schedule_;
  FakeClock clock_;
  Nanoseconds start_ = clock_.now();
  FakePipeline pipeline_;
};

TEST(LiveSchedule, DoesNotDriftWhereThePeriodIsNoWholeNumberOfNanoseconds) {
  const LiveSchedule schedule = {.rate_hz = 3, .frames = 0};
  EXPECT_EQ(schedule.due(0), Nanoseconds(0));
  EXPECT_EQ(schedule.due(1), Nanoseconds(333'333'333));
  EXPECT_EQ(schedule.due(30'000'000), seconds(10'000'000));
}

TEST_F(LiveRunTest, SolvesEachFrameWhenItIsDue) {
  const LiveResult result = run();
  EXPECT_EQ(result.latencies, std::vector<Nanoseconds>(100, kSolve));
  EXPECT_EQ(result.dropped, 0);
  EXPECT_FALSE(result.interrupted);
  EXPECT_EQ(result.elapsed, milliseconds(100));
  EXPECT_EQ(pipeline_.most_in_flight, 1);
  for (std::uint64_t frame = 0; frame < 100; ++frame) {
    EXPECT_EQ(pipeline_.submitted.at(frame), frame);
    EXPECT_EQ(pipeline_.submitted_at.at(frame) - start_, milliseconds(frame));
  }
}

TEST_F(LiveRunTest, AStallCountsAgainstEveryFrameThatItDelays) {
  pipeline_.durations[10] = microseconds(3300);
  const LiveResult result = run();
  EXPECT_EQ(result.dropped, 0);
  std::vector<Nanoseconds> expected(100, kSolve);
  expected[10] = microseconds(3300);  // Done at 13.3 ms; the next two start then,
  expected[11] = microseconds(2700);  // done at 13.7,
  expected[12] = microseconds(2100);  // at 14.1,
  expected[13] = microseconds(1500);  // at 14.5: the pipeline catches up by 0.6 ms a frame.
  expected[14] = microseconds(900);
  EXPECT_EQ(result.latencies, expected);
  EXPECT_EQ(pipeline_.most_in_flight, 2);
}

TEST_F(LiveRunTest, FramesThatAreLateByMoreThanTheBacklogAreDroppedTheNewestKept) {
  pipeline_.durations[10] = milliseconds(10);
  const LiveResult result = run();
  // Done at 20 ms, when frames 11 to 15 are late by 9 to 5 periods, and frame 16 by 4.
  EXPECT_EQ(result.dropped, 5);
  EXPECT_EQ(result.solved(), 95);
  EXPECT_EQ(result.scheduled(), 100);
  EXPECT_EQ(pipeline_.submitted.at(10), 10);
  EXPECT_EQ(pipeline_.submitted.at(11), 16);
  EXPECT_EQ(result.latencies.at(10), milliseconds(10));
  EXPECT_EQ(result.latencies.at(11), microseconds(4400));
  EXPECT_EQ(result.latencies.at(12), microseconds(3800));
  EXPECT_EQ(result.latencies.back(), kSolve);
}

TEST_F(LiveRunTest, WithoutABacklogALateFrameIsDropped) {
  schedule_.backlog_frames = 0;
  pipeline_.durations[10] = microseconds(1100);
  const LiveResult result = run();
  EXPECT_EQ(result.dropped, 1);
  EXPECT_EQ(pipeline_.submitted.at(11), 12);
}

TEST_F(LiveRunTest, AnImpossibleRateDropsWhatCannotBeSolvedAndKeepsLatenciesBounded) {
  std::ranges::fill(pipeline_.durations, microseconds(1500));
  const LiveResult result = run();
  EXPECT_EQ(result.scheduled(), 100);
  EXPECT_NEAR(static_cast<double>(result.solved()), 100 / 1.5, 6);
  // Four periods late, and two frames to be solved.
  EXPECT_LE(*std::ranges::max_element(result.latencies), milliseconds(4 + 3));
  EXPECT_EQ(pipeline_.most_in_flight, 2);
}

TEST_F(LiveRunTest, ASleepThatEndsLateIsPartOfTheLatency) {
  clock_.wake = [](Nanoseconds, Nanoseconds time) { return time + microseconds(70); };
  const LiveResult result = run();
  EXPECT_EQ(result.latencies.front(), kSolve);  // due at once
  for (std::size_t i = 1; i < 100; ++i) EXPECT_EQ(result.latencies[i], kSolve + microseconds(70));
}

TEST_F(LiveRunTest, ASleepThatEndsEarlyIsTakenUpAgain) {
  clock_.wake = [](Nanoseconds now, Nanoseconds time) {
    return now + (time - now + Nanoseconds(1)) / 2;
  };
  EXPECT_EQ(run().latencies, std::vector<Nanoseconds>(100, kSolve));
}

TEST_F(LiveRunTest, SpinsForTheLastPartOfAWait) {
  schedule_.spin = microseconds(50);
  clock_.tick = Nanoseconds(100);
  clock_.wake = [](Nanoseconds, Nanoseconds time) { return time + microseconds(30); };
  const LiveResult result = run();
  EXPECT_EQ(clock_.sleeps, 100);  // one before each frame but the first, and one for the end
  for (const Nanoseconds latency : result.latencies) {
    EXPECT_GE(latency, kSolve);
    EXPECT_LT(latency, kSolve + microseconds(1));  // though each sleep ends 30 late
  }
}

TEST_F(LiveRunTest, AnInterruptEndsTheRunOnceTheFramesInFlightAreReceived) {
  pipeline_.durations[20] = microseconds(2500);
  const LiveResult result = run([&] { return pipeline_.submitted.size() == 22; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.solved(), 22);
  EXPECT_EQ(result.scheduled(), 22);
  EXPECT_EQ(pipeline_.in_flight(), 0);
  EXPECT_EQ(result.elapsed, microseconds(22'900));
}

TEST_F(LiveRunTest, AnInterruptDuringAWaitEndsIt) {
  clock_.wake = [](Nanoseconds now, Nanoseconds) { return now + microseconds(100); };
  const LiveResult result = run([&] { return clock_.now() - start_ >= microseconds(1500); });
  EXPECT_TRUE(result.interrupted);
  EXPECT_EQ(result.solved(), 2);
  EXPECT_EQ(result.elapsed, microseconds(1500));
}

/// Whatever the times, no frame is lost, none comes early, and none takes less than its own time.
TEST(LiveRun, AccountsForEveryFrameOfRandomRuns) {
  std::mt19937 random(20);
  for (int round = 0; round < 200; ++round) {
    const LiveSchedule schedule = {
        .rate_hz = std::uniform_real_distribution(100.0, 5000.0)(random),
        .frames = 300,
        .backlog_frames = std::uniform_int_distribution<std::uint64_t>(0, 6)(random)};
    FakeClock clock;
    clock.wake = [&](Nanoseconds, Nanoseconds time) {
      return time + microseconds(std::uniform_int_distribution(-50, 200)(random));
    };
    FakePipeline pipeline(clock, schedule.frames, Nanoseconds(0));
    for (Nanoseconds& duration : pipeline.durations) {
      duration = microseconds(std::geometric_distribution(1 / 300.0)(random));
    }
    const Nanoseconds start = clock.now();
    LiveRun run(schedule);
    run.run(clock, pipeline, kNever);
    const LiveResult& result = run.result();
    ASSERT_EQ(result.scheduled(), schedule.frames);
    ASSERT_EQ(result.solved(), pipeline.submitted.size());
    ASSERT_TRUE(std::ranges::is_sorted(pipeline.submitted));
    const Nanoseconds longest_wait = schedule.due(schedule.backlog_frames);
    for (std::size_t i = 0; i < pipeline.submitted.size(); ++i) {
      const std::uint64_t frame = pipeline.submitted[i];
      const Nanoseconds late = pipeline.submitted_at[i] - start - schedule.due(frame);
      ASSERT_GE(late, Nanoseconds(0));
      ASSERT_LE(late, longest_wait);
      ASSERT_GE(result.latencies[i], late + pipeline.durations[frame]);
    }
  }
}

TEST_F(LiveRunTest, TakesNoMemory) {
  pipeline_.durations[30] = milliseconds(9);
  LiveRun run(schedule_);
  const std::uint64_t before = cli_test::allocations();
  run.run(clock_, pipeline_, kNever);
  EXPECT_EQ(cli_test::allocations(), before);
  EXPECT_GT(run.result().dropped, 0);
  const auto something = std::make_unique<int>(1);
  EXPECT_EQ(cli_test::allocations(), before + 1) << "the count does not count";
}

}  // namespace
}  // namespace pillarfield::cli
