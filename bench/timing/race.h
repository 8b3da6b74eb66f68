#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace pillarfield::bench {

/// Works off so many frames, and leaves none of them in flight.
using Work = std::function<void(int frames)>;

/// How long a race is. Every limit is a least one.
struct RaceLength {
  double seconds = 1;          ///< of the whole race
  int rounds = 15;             ///< in which each contestant has one turn
  double turn_seconds = 4e-3;  ///< of a turn
  int turn_frames = 2;         ///< of a turn
};

/// Runs contestants in turns, so that whatever slows the machine for a while slows all of them, and
/// compares them round by round. The order is reversed from one round to the next: nobody always
/// runs after the same other.
class Race {
 public:
  /// Seconds since some moment.
  using Clock = std::function<double()>;

  /// By the time that passes, and the processor time that all threads of the program take.
  Race();
  Race(Clock clock, Clock processor_clock);

  /// Returns the contestant's number, from 0 on.
  std::size_t add(Work work);

  /// Warms every contestant up, which also finds how many frames its turns have, and races.
  void run(const RaceLength& length);

  /// Seconds per frame of a contestant, one for each round.
  [[nodiscard]] std::span<const double> times(std::size_t contestant) const;

  /// Of those; `share` is 0..1.
  [[nodiscard]] double quantile(std::size_t contestant, double share) const;
  [[nodiscard]] double median(std::size_t contestant) const;

  /// The median over the rounds of one contestant's time over another's in the same round.
  [[nodiscard]] double ratio(std::size_t numerator, std::size_t denominator) const;

  /// Processor time of a frame, the median over the rounds, seconds; and ratio() of such times.
  /// What others run on the machine changes them less.
  [[nodiscard]] double processor_median(std::size_t contestant) const;
  [[nodiscard]] double processor_ratio(std::size_t numerator, std::size_t denominator) const;

  /// The one of the least median.
  [[nodiscard]] std::size_t fastest(std::span<const std::size_t> contestants) const;

 private:
  struct Contestant {
    Work work;
    int frames = 0;  ///< of a turn
    std::vector<double> times;
    std::vector<double> processor_times;
  };

  [[nodiscard]] double time(const Contestant& contestant, int frames) const;
  void warm_up(Contestant& contestant, const RaceLength& length) const;
  void take_turn(Contestant& contestant) const;

  Clock clock_;
  Clock processor_clock_;
  std::vector<Contestant> contestants_;
};

}  // namespace pillarfield::bench
