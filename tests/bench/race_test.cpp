// Races by a clock of the test's own: who is how fast is known.

#include "bench/timing/race.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace pillarfield::bench {
namespace {

/// A machine whose speed the test sets, with clocks that contestants move: that of the processor
/// by a quarter as much, however slow the machine is.
class Machine {
 public:
  [[nodiscard]] Race race() {
    return {[this] { return now_; }, [this] { return processor_; }};
  }

  /// A contestant that takes `seconds` a frame on the machine as it was at first.
  Work contestant(const char* name, double seconds) {
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

constexpr RaceLength kFiveRounds = {.seconds = 0, .rounds = 5, .turn_seconds = 0, .turn_frames = 3};

TEST(Race, TimesAreThoseOfAFrame) {
  Machine machine;
  Race race = machine.race();
  const auto a = race.add(machine.contestant("a", 2));
  const auto b = race.add(machine.contestant("b", 6));
  race.run(kFiveRounds);
  EXPECT_EQ(race.times(a).size(), 5U);
  EXPECT_DOUBLE_EQ(race.median(a), 2);
  EXPECT_DOUBLE_EQ(race.median(b), 6);
  EXPECT_DOUBLE_EQ(race.ratio(b, a), 3);
  EXPECT_DOUBLE_EQ(race.ratio(a, b), 1.0 / 3);
}

TEST(Race, ProcessorTimeIsThatOfAFrameTooAndDoesNotDrift) {
  Machine machine;
  Race race = machine.race();
  const Work steady = machine.contestant("a", 2);
  double slowness = 1;
  const auto a = race.add([&](int frames) {
    machine.set_slowness(slowness *= 3);
    steady(frames);
  });
  const auto b = race.add(machine.contestant("b", 6));
  race.run(kFiveRounds);
  EXPECT_GT(race.median(a), 2) << "the machine did not drift";
  EXPECT_DOUBLE_EQ(race.processor_median(a), 0.5);
  EXPECT_DOUBLE_EQ(race.processor_median(b), 1.5);
  EXPECT_DOUBLE_EQ(race.processor_ratio(b, a), 3);
}

TEST(Race, OrderIsReversedFromRoundToRound) {
  Machine machine;
  Race race = machine.race();
  for (const char* const name : {"a", "b", "c"}) race.add(machine.contestant(name, 1));
  race.run(kFiveRounds);
  // Twice each to warm up.
  EXPECT_EQ(machine.turns(), "aabbccabccbaabccbaabc");
}

TEST(Race, DriftLeavesPairedRatiosAsTheyAre) {
  Machine machine;
  Race race = machine.race();
  double slowness = 1;
  int turn = 0;
  // The machine slows down in every round, for both contestants alike.
  const auto in_round = [&](const Work& work) {
    return [&, work](int frames) {
      if (turn++ % 2 == 0) machine.set_slowness(slowness *= 1.5);
      work(frames);
    };
  };
  const auto a = race.add(in_round(machine.contestant("a", 1)));
  const auto b = race.add(in_round(machine.contestant("b", 4)));
  race.run(kFiveRounds);
  EXPECT_GT(race.quantile(a, 1), 4 * race.quantile(a, 0)) << "the machine did not drift";
  EXPECT_DOUBLE_EQ(race.ratio(b, a), 4);
}

TEST(Race, OneBadRoundDoesNotCount) {
  Machine machine;
  Race race = machine.race();
  int turn = 0;
  const Work steady = machine.contestant("a", 1);
  const auto a = race.add([&](int frames) {
    machine.set_slowness(++turn == 4 ? 100 : 1);
    steady(frames);
    machine.set_slowness(1);
  });
  const auto b = race.add(machine.contestant("b", 2));
  race.run(kFiveRounds);
  EXPECT_DOUBLE_EQ(race.quantile(a, 1), 100) << "there was no bad round";
  EXPECT_DOUBLE_EQ(race.median(a), 1);
  EXPECT_DOUBLE_EQ(race.ratio(b, a), 2);
}

TEST(Race, LastsAsLongAsItIsTold) {
  Machine machine;
  Race race = machine.race();
  const auto a = race.add(machine.contestant("a", 0.5));
  race.run({.seconds = 60, .rounds = 2, .turn_seconds = 0, .turn_frames = 1});
  EXPECT_EQ(race.times(a).size(), 120U);
}

TEST(Race, TurnsHaveFramesEnough) {
  Machine machine;
  Race race = machine.race();
  race.add(machine.contestant("a", 0.25));
  race.run({.seconds = 0, .rounds = 1, .turn_seconds = 2, .turn_frames = 1});
  // 1 and then 1, 2, 4, 8 frames to warm up, the last for two seconds; so many in the race.
  EXPECT_EQ(machine.frames(), 1 + 1 + 2 + 4 + 8 + 8);
}

TEST(Race, FastestHasTheLeastMedian) {
  Machine machine;
  Race race = machine.race();
  const auto a = race.add(machine.contestant("a", 3));
  const auto b = race.add(machine.contestant("b", 2));
  const auto c = race.add(machine.contestant("c", 1));
  race.run(kFiveRounds);
  EXPECT_EQ(race.fastest(std::array{a, b}), b);
  EXPECT_EQ(race.fastest(std::array{a, b, c}), c);
  EXPECT_EQ(race.fastest(std::array{a}), a);
}

}  // namespace
}  // namespace pillarfield::bench
