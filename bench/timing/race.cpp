#include "bench/timing/race.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/quantile.h"

namespace pillarfield::bench {
namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// The median of ratios, pair by pair.
double paired_ratio(std::span<const double> over, std::span<const double> under) {
  std::vector<double> ratios(over.size());
  std::transform(over.begin(), over.end(), under.begin(), ratios.begin(), std::divides());
  return median(ratios);
}

}  // namespace

Race::Race() : Race(steady_seconds, processor_seconds) {}
Race::Race(Clock clock, Clock processor_clock)
    : clock_(std::move(clock)), processor_clock_(std::move(processor_clock)) {}

std::size_t Race::add(Work work) {
  contestants_.push_back({std::move(work), 0, {}, {}});
  return contestants_.size() - 1;
}

void Race::run(const RaceLength& length) {
  for (Contestant& contestant : contestants_) warm_up(contestant, length);
  const double start = clock_();
  for (int round = 0; round < length.rounds || clock_() - start < length.seconds; ++round) {
    if (round % 2 == 0) {
      for (Contestant& contestant : contestants_) take_turn(contestant);
    } else {
      std::for_each(contestants_.rbegin(), contestants_.rend(),
                    [&](Contestant& contestant) { take_turn(contestant); });
    }
  }
}

std::span<const double> Race::times(std::size_t contestant) const {
  return contestants_.at(contestant).times;
}

double Race::quantile(std::size_t contestant, double share) const {
  std::vector<double> sample = contestants_.at(contestant).times;
  return pillarfield::quantile(sample, share);
}

double Race::median(std::size_t contestant) const { return quantile(contestant, 0.5); }

double Race::ratio(std::size_t numerator, std::size_t denominator) const {
  return paired_ratio(times(numerator), times(denominator));
}

double Race::processor_median(std::size_t contestant) const {
  std::vector<double> sample = contestants_.at(contestant).processor_times;
  return pillarfield::median(sample);
}

double Race::processor_ratio(std::size_t numerator, std::size_t denominator) const {
  return paired_ratio(contestants_.at(numerator).processor_times,
                      contestants_.at(denominator).processor_times);
}

std::size_t Race::fastest(std::span<const std::size_t> contestants) const {
  return *std::ranges::min_element(contestants, {}, [&](std::size_t i) { return median(i); });
}

double Race::time(const Contestant& contestant, int frames) const {
  const double start = clock_();
  contestant.work(frames);
  return clock_() - start;
}

void Race::warm_up(Contestant& contestant, const RaceLength& length) const {
  contestant.times.clear();
  contestant.processor_times.clear();
  contestant.frames = length.turn_frames;
  contestant.work(contestant.frames);  // The first turn pays for compiling and for pages.
  while (time(contestant, contestant.frames) < length.turn_seconds) contestant.frames *= 2;
}

void Race::take_turn(Contestant& contestant) const {
  const double processor_start = processor_clock_();
  contestant.times.push_back(time(contestant, contestant.frames) / contestant.frames);
  contestant.processor_times.push_back((processor_clock_() - processor_start) / contestant.frames);
}

}  // namespace pillarfield::bench
