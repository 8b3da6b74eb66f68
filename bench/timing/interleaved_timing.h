#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace pillarfield::bench {

/// Processes `frames` frames and leaves none in flight.
using Work = std::function<void(int frames)>;

/// Minimum lengths of a timing.
struct TimingLength {
  double seconds = 1;          ///< of the whole timing
  int rounds = 15;             ///< each candidate has one turn a round
  double turn_seconds = 4e-3;  ///< of a turn
  int turn_frames = 2;         ///< of a turn
};

/// Times candidates in turns and compares them round by round, so that a disturbance of the machine
/// affects all of them. The order is reversed from round to round.
class InterleavedTiming {
 public:
  /// Returns the candidate's index.
  std::size_t add(Work work);

  /// Warms up every candidate, which determines the frames of its turns, and times all.
  void run(const TimingLength& length);

  /// Seconds per frame of a candidate, one value per round.
  [[nodiscard]] std::span<const double> times(std::size_t candidate) const;

  /// Quantile of times(); `fraction` is 0..1.
  [[nodiscard]] double quantile(std::size_t candidate, double fraction) const;
  [[nodiscard]] double median(std::size_t candidate) const;

  /// Median over the rounds of the ratio of two candidates' times.
  [[nodiscard]] double ratio(std::size_t numerator, std::size_t denominator) const;

  /// ratio() of the processor times of all threads, which other programs disturb less.
  [[nodiscard]] double processor_ratio(std::size_t numerator, std::size_t denominator) const;

  /// The candidate of the least median.
  [[nodiscard]] std::size_t fastest(std::span<const std::size_t> candidates) const;

 private:
  struct Candidate {
    Work work;
    int frames = 0;  ///< of a turn
    std::vector<double> times;
    std::vector<double> processor_times;
  };

  static double time(const Candidate& candidate, int frames);
  static void warm_up(Candidate& candidate, const TimingLength& length);
  static void take_turn(Candidate& candidate);

  std::vector<Candidate> candidates_;
};

}  // namespace pillarfield::bench
