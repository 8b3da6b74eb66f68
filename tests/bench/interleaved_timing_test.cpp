// Interleaved timing by simulated clocks.

#include "bench/timing/interleaved_timing.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace pillarfield::bench {
namespace {

/// A machine of adjustable speed, whose clocks advance as candidates work. Processor time is a
/// quarter of the time at slowness 1, and does not depend on the slowness.
class Machine {
 public:
  [[nodiscard]] InterleavedTiming timing() {
    return {[this] { return now_; }, [this] { return processor_; }};
  }

  /// A candidate that takes `seconds` a frame at slowness 1.
  Work candidate(const char* name, double seconds) {
    return [this, name, seconds](int frames) {
      turns_ += name;
      frames_ += frames;
      now_ += frames * seconds * slowness_;
      processor_ += frames * seconds / 4;
    };
  }

  void set_slowness(double slowness) { slowness_ = slowness; }
  [[nodiscard]] const std::string& turns() const { return turns_; }
  [[nodiscard]] int frames() const { return frames_; }

 private:
  double now_ = 100;
  double processor_ = 7;
  double slowness_ = 1;
  std::string turns_;
  int frames_ = 0;
};

constexpr TimingLength kFiveRounds = {
    .seconds = 0, .rounds = 5, .turn_seconds = 0, .turn_frames = 3};

TEST(InterleavedTiming, TimesAreThoseOfAFrame) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  const auto a = timing.add(machine.candidate("a", 2));
  const auto b = timing.add(machine.candidate("b", 6));
  timing.run(kFiveRounds);
  EXPECT_EQ(timing.times(a).size(), 5U);
  EXPECT_DOUBLE_EQ(timing.median(a), 2);
  EXPECT_DOUBLE_EQ(timing.median(b), 6);
  EXPECT_DOUBLE_EQ(timing.ratio(b, a), 3);
  EXPECT_DOUBLE_EQ(timing.ratio(a, b), 1.0 / 3);
}

TEST(InterleavedTiming, ProcessorTimeIsThatOfAFrameTooAndDoesNotDrift) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  const Work steady = machine.candidate("a", 2);
  double slowness = 1;
  const auto a = timing.add([&](int frames) {
    machine.set_slowness(slowness *= 3);
    steady(frames);
  });
  const auto b = timing.add(machine.candidate("b", 6));
  timing.run(kFiveRounds);
  EXPECT_GT(timing.median(a), 2) << "the machine did not drift";
  EXPECT_DOUBLE_EQ(timing.processor_median(a), 0.5);
  EXPECT_DOUBLE_EQ(timing.processor_median(b), 1.5);
  EXPECT_DOUBLE_EQ(timing.processor_ratio(b, a), 3);
}

TEST(InterleavedTiming, OrderIsReversedFromRoundToRound) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  for (const char* const name : {"a", "b", "c"}) timing.add(machine.candidate(name, 1));
  timing.run(kFiveRounds);
  // Two turns each to warm up.
  EXPECT_EQ(machine.turns(), "aabbccabccbaabccbaabc");
}

TEST(InterleavedTiming, DriftLeavesPairedRatiosAsTheyAre) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  double slowness = 1;
  int turn = 0;
  // The machine slows down in every round, equally for both candidates.
  const auto in_round = [&](const Work& work) {
    return [&, work](int frames) {
      if (turn++ % 2 == 0) machine.set_slowness(slowness *= 1.5);
      work(frames);
    };
  };
  const auto a = timing.add(in_round(machine.candidate("a", 1)));
  const auto b = timing.add(in_round(machine.candidate("b", 4)));
  timing.run(kFiveRounds);
  EXPECT_GT(timing.quantile(a, 1), 4 * timing.quantile(a, 0)) << "the machine did not drift";
  EXPECT_DOUBLE_EQ(timing.ratio(b, a), 4);
}

TEST(InterleavedTiming, OneBadRoundDoesNotCount) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  int turn = 0;
  const Work steady = machine.candidate("a", 1);
  const auto a = timing.add([&](int frames) {
    machine.set_slowness(++turn == 4 ? 100 : 1);
    steady(frames);
    machine.set_slowness(1);
  });
  const auto b = timing.add(machine.candidate("b", 2));
  timing.run(kFiveRounds);
  EXPECT_DOUBLE_EQ(timing.quantile(a, 1), 100) << "there was no bad round";
  EXPECT_DOUBLE_EQ(timing.median(a), 1);
  EXPECT_DOUBLE_EQ(timing.ratio(b, a), 2);
}

TEST(InterleavedTiming, LastsTheMinimumTime) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  const auto a = timing.add(machine.candidate("a", 0.5));
  timing.run({.seconds = 60, .rounds = 2, .turn_seconds = 0, .turn_frames = 1});
  EXPECT_EQ(timing.times(a).size(), 120U);
}

TEST(InterleavedTiming, TurnsHaveFramesEnough) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  timing.add(machine.candidate("a", 0.25));
  timing.run({.seconds = 0, .rounds = 1, .turn_seconds = 2, .turn_frames = 1});
  // Warm-up: 1, then 1, 2, 4, 8 frames, the last for two seconds; then one turn of 8.
  EXPECT_EQ(machine.frames(), 1 + 1 + 2 + 4 + 8 + 8);
}

TEST(InterleavedTiming, FastestHasTheLeastMedian) {
  Machine machine;
  InterleavedTiming timing = machine.timing();
  const auto a = timing.add(machine.candidate("a", 3));
  const auto b = timing.add(machine.candidate("b", 2));
  const auto c = timing.add(machine.candidate("c", 1));
  timing.run(kFiveRounds);
  EXPECT_EQ(timing.fastest(std::array{a, b}), b);
  EXPECT_EQ(timing.fastest(std::array{a, b, c}), c);
  EXPECT_EQ(timing.fastest(std::array{a}), a);
}

}  // namespace
}  // namespace pillarfield::bench
