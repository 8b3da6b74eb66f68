#include "bench/timing/interleaved_timing.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

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

/// The smallest value that at least a fraction `probability` of the values do not exceed.
double quantile_of(std::vector<double> values, double probability) {
  const double rank = std::ceil(probability * static_cast<double>(values.size())) - 1;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, rank));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Median of the pairwise ratios.
double paired_ratio(std::span<const double> over, std::span<const double> under) {
  std::vector<double> ratios(over.size());
  std::transform(over.begin(), over.end(), under.begin(), ratios.begin(), std::divides());
  return quantile_of(std::move(ratios), 0.5);
}

}  // namespace

std::size_t InterleavedTiming::add(Work work) {
  candidates_.push_back({std::move(work), 0, {}, {}});
  return candidates_.size() - 1;
}

void InterleavedTiming::run(const TimingLength& length) {
  for (Candidate& candidate : candidates_) warm_up(candidate, length);
  const double start = steady_seconds();
  for (int round = 0; round < length.rounds || steady_seconds() - start < length.seconds; ++round) {
    if (round % 2 == 0) {
      for (Candidate& candidate : candidates_) take_turn(candidate);
    } else {
      std::for_each(candidates_.rbegin(), candidates_.rend(),
                    [&](Candidate& candidate) { take_turn(candidate); });
    }
  }
}

std::span<const double> InterleavedTiming::times(std::size_t candidate) const {
  return candidates_.at(candidate).times;
}

double InterleavedTiming::quantile(std::size_t candidate, double fraction) const {
  return quantile_of(candidates_.at(candidate).times, fraction);
}

double InterleavedTiming::median(std::size_t candidate) const { return quantile(candidate, 0.5); }

double InterleavedTiming::ratio(std::size_t numerator, std::size_t denominator) const {
  return paired_ratio(times(numerator), times(denominator));
}

double InterleavedTiming::processor_ratio(std::size_t numerator, std::size_t denominator) const {
  return paired_ratio(candidates_.at(numerator).processor_times,
                      candidates_.at(denominator).processor_times);
}

std::size_t InterleavedTiming::fastest(std::span<const std::size_t> candidates) const {
  return *std::ranges::min_element(candidates, {}, [&](std::size_t i) { return median(i); });
}

double InterleavedTiming::time(const Candidate& candidate, int frames) {
  const double start = steady_seconds();
  candidate.work(frames);
  return steady_seconds() - start;
}

void InterleavedTiming::warm_up(Candidate& candidate, const TimingLength& length) {
  candidate.times.clear();
  candidate.processor_times.clear();
  candidate.frames = length.turn_frames;
  candidate.work(candidate.frames);  // The first turn compiles and maps pages.
  while (time(candidate, candidate.frames) < length.turn_seconds) candidate.frames *= 2;
}

void InterleavedTiming::take_turn(Candidate& candidate) {
  const double processor_start = processor_seconds();
  candidate.times.push_back(time(candidate, candidate.frames) / candidate.frames);
  candidate.processor_times.push_back((processor_seconds() - processor_start) / candidate.frames);
}

}  // namespace pillarfield::bench
