// The play head under a simulated clock.

#include "viewer/source/playback.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

using Time = Playback::Time;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Time kStart = seconds(1000);

/// A head after its first frame.
Playback head(std::uint64_t frames, double rate_hz) {
  Playback playback(frames, rate_hz);
  EXPECT_EQ(playback.next(kStart), 0U);
  return playback;
}

/// All frames that are due at `now`.
std::vector<std::uint64_t> all_due(Playback& playback, Time now) {
  std::vector<std::uint64_t> frames;
  while (const auto frame = playback.next(now)) frames.push_back(*frame);
  return frames;
}

TEST(Playback, GivesEveryFrameAtAnyPollingRate) {
  std::mt19937 random(3);
  for (const double rate_hz : {7.0, 100.0, 4321.0}) {
    for (const double speed : {0.05, 1.0, 13.0}) {
      Playback playback = head(17, rate_hz);
      playback.set_speed(speed, kStart);
      playback.play(kStart);
      std::uint64_t expected = 0;
      Time now = kStart;
      for (int i = 0; i < 3000; ++i) {
        now += microseconds(std::uniform_int_distribution(0, 3000)(random));
        if (i % 500 == 499) now += seconds(3);  // A pause of the caller.
        const auto frame = playback.next(now);
        if (!frame) continue;
        expected = (expected + 1) % 17;
        ASSERT_EQ(*frame, expected);
        ASSERT_EQ(playback.frame(), expected);
      }
    }
  }
}

TEST(Playback, KeepsItsRateWithoutDrift) {
  for (const double rate_hz : {3.0, 29.97, 1000.0 / 7}) {
    for (const double speed : {0.1, 1.0, 3.0}) {
      Playback playback = head(1000, rate_hz);
      playback.set_speed(speed, kStart);
      playback.play(kStart);
      for (std::uint64_t count = 1; count <= 5000; ++count) {
        const Time due = *playback.next_due();
        const double expected_ns = 1e9 * static_cast<double>(count) / (rate_hz * speed);
        ASSERT_NEAR(static_cast<double>((due - kStart).count()), expected_ns, 1.5);
        ASSERT_EQ(playback.next(due - Time(1)), std::nullopt) << "before it is due";
        ASSERT_EQ(playback.next(due), count % 1000);
      }
    }
  }
}

TEST(Playback, StopsAtTheEndWithoutLoopAndRestarts) {
  Playback playback = head(3, 10);
  playback.set_loop(false);
  playback.play(kStart);
  EXPECT_EQ(all_due(playback, kStart + milliseconds(900)), (std::vector<std::uint64_t>{1, 2}));
  EXPECT_FALSE(playback.playing());
  EXPECT_EQ(playback.frame(), 2U);
  EXPECT_EQ(playback.next_due(), std::nullopt);
  playback.play(kStart + seconds(5));
  EXPECT_EQ(all_due(playback, kStart + milliseconds(5250)), (std::vector<std::uint64_t>{0, 1, 2}));
  EXPECT_FALSE(playback.playing());
}

TEST(Playback, PauseHoldsAndPlayGoesOn) {
  Playback playback = head(100, 10);
  playback.play(kStart);
  EXPECT_EQ(playback.next(kStart + milliseconds(100)), 1U);
  playback.pause();
  EXPECT_EQ(playback.next(kStart + seconds(20)), std::nullopt);
  playback.play(kStart + seconds(20));
  EXPECT_EQ(playback.next(kStart + seconds(20) + milliseconds(99)), std::nullopt);
  EXPECT_EQ(playback.next(kStart + seconds(20) + milliseconds(100)), 2U);
  playback.play(kStart + seconds(20) + milliseconds(190));  // It plays already.
  EXPECT_EQ(playback.next(kStart + seconds(20) + milliseconds(200)), 3U);
}

TEST(Playback, SeeksAndClamps) {
  Playback playback = head(10, 10);
  playback.seek(7, kStart);
  EXPECT_EQ(playback.frame(), 7U);
  EXPECT_EQ(playback.next(kStart), 7U);
  EXPECT_EQ(playback.next(kStart + seconds(1)), std::nullopt) << "seeking does not play";
  playback.seek(1000, kStart);
  EXPECT_EQ(playback.next(kStart), 9U);
  playback.play(kStart);
  playback.seek(3, kStart + milliseconds(50));
  playback.seek(4, kStart + milliseconds(60));
  EXPECT_TRUE(playback.playing());
  EXPECT_EQ(playback.next(kStart + milliseconds(60)), 4U) << "the last one sought";
  EXPECT_EQ(playback.next(kStart + milliseconds(159)), std::nullopt) << "is shown for a period";
  EXPECT_EQ(playback.next(kStart + milliseconds(160)), 5U);
}

TEST(Playback, StepsPauseWrapAndClamp) {
  constexpr auto kLowest = std::numeric_limits<std::int64_t>::min();
  constexpr auto kHighest = std::numeric_limits<std::int64_t>::max();
  Playback playback = head(10, 10);
  playback.play(kStart);
  playback.step(3, kStart);
  EXPECT_FALSE(playback.playing());
  EXPECT_EQ(playback.next(kStart), 3U);
  const auto steps_to = [&](std::int64_t frames, std::uint64_t expected) {
    playback.step(frames, kStart);
    EXPECT_EQ(playback.frame(), expected) << frames;
    EXPECT_EQ(playback.next(kStart), expected) << frames;
  };
  steps_to(-4, 9);
  steps_to(1, 0);
  steps_to(-23, 7);
  steps_to(kHighest, static_cast<std::uint64_t>((7 + kHighest % 10) % 10));
  playback.seek(5, kStart);
  steps_to(kLowest, static_cast<std::uint64_t>((5 + kLowest % 10 + 10) % 10));
  playback.set_loop(false);
  steps_to(kHighest, 9);
  steps_to(1, 9);
  steps_to(kLowest, 0);
  steps_to(-1, 0);
}

TEST(Playback, SpeedAndRateHaveLimits) {
  Playback playback(10, -3);
  EXPECT_GT(playback.rate_hz(), 0);
  for (const double absurd : {0.0, -1.0, std::nan(""), -std::numeric_limits<double>::infinity()}) {
    playback.set_speed(absurd, kStart);
    EXPECT_EQ(playback.speed(), 0.01);
  }
  playback.set_speed(std::numeric_limits<double>::infinity(), kStart);
  EXPECT_EQ(playback.speed(), 100);
  EXPECT_THROW(Playback(0, 10), Error);
}

TEST(Playback, FollowsTheNewestFrame) {
  Playback playback = head(10, 100);
  playback.play(kStart);
  playback.set_follow(true, kStart);
  EXPECT_TRUE(playback.follows());
  EXPECT_FALSE(playback.playing());
  EXPECT_EQ(playback.next(kStart), 9U);
  EXPECT_EQ(playback.next(kStart + seconds(1)), std::nullopt);
  playback.set_frames(10, kStart);
  EXPECT_EQ(playback.next(kStart), std::nullopt) << "nothing new";
  playback.set_frames(14, kStart);
  EXPECT_EQ(playback.next(kStart), 13U);
  playback.step(-1, kStart);
  EXPECT_FALSE(playback.follows());
  EXPECT_EQ(playback.next(kStart), 12U);
  playback.set_frames(20, kStart);
  EXPECT_EQ(playback.next(kStart), std::nullopt) << "it follows no more";
  EXPECT_EQ(playback.frames(), 20U);
}

TEST(Playback, IsLateByASecondAtMost) {
  Playback playback = head(1'000'000, 100);
  playback.play(kStart);
  const Time late = kStart + seconds(60);
  EXPECT_EQ(playback.next(late), 1U) << "late, but not left out";
  EXPECT_EQ(all_due(playback, late).size(), 100U) << "the frames of one second";
  EXPECT_EQ(playback.next(late + milliseconds(10)), 102U) << "in time again";
}

TEST(Playback, PlaysIntoFramesThatWereAdded) {
  Playback playback = head(3, 10);
  playback.play(kStart);
  playback.set_frames(5, kStart);
  EXPECT_EQ(all_due(playback, kStart + milliseconds(550)),
            (std::vector<std::uint64_t>{1, 2, 3, 4, 0}));
  playback.seek(4, kStart);
  playback.set_frames(2, kStart);
  EXPECT_EQ(playback.next(kStart), 1U) << "the source shrank";
}

}  // namespace
}  // namespace pillarfield::viewer
