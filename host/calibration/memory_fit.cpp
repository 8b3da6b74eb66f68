#include "calibration/memory_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "calibration/golden_section.h"
#include "calibration/normal_equations.h"

namespace pillarfield {
namespace {

/// Widths of the plays as fractions of the range.
constexpr std::array<double, kMaxPlays> kWidths = {1.0 / 8, 3.0 / 8, 5.0 / 8, 7.0 / 8};
constexpr std::size_t kCreepTimes = 12;
/// Largest dead zone as a fraction of the range.
constexpr double kMostZone = 0.2;
/// Weight, as a fraction of the range, of equal slopes of neighbouring pieces.
constexpr double kSmoothness = 0.05;
/// A dead zone is kept if it lowers the squares below this fraction.
constexpr double kZoneWins = 0.98;

using Samples = std::vector<MemoryFinder::Sample>;

double range_of(const Samples& samples) {
  return std::ranges::max(samples, {}, &MemoryFinder::Sample::load_counts).load_counts;
}

/// Creep times from twice the shortest interval, or a 3000th of the duration, to three times it.
std::array<double, kCreepTimes> creep_times(const Samples& samples) {
  double shortest = std::numeric_limits<double>::infinity();
  double longest = 0;
  double duration = 0;
  for (const auto& sample : samples) {
    duration = sample.interval_s > 0 ? duration + sample.interval_s : 0;
    if (sample.interval_s > 0) shortest = std::min(shortest, sample.interval_s);
    longest = std::max(longest, duration);
  }
  const double first = std::max(2 * shortest, longest / 3000);
  std::array<double, kCreepTimes> times{};
  for (std::size_t i = 0; i < times.size(); ++i) {
    times.at(i) = first * std::pow(3 * longest / first, static_cast<double>(i) / (kCreepTimes - 1));
  }
  return times;
}

/// Brings the columns of creep from the load `before` a sample to the sample.
void creep_on(std::span<double> states, const std::array<double, kCreepTimes>& times,
              double interval_s, double before) {
  const bool first = interval_s <= 0;
  for (std::size_t i = 0; i < kCreepTimes; ++i) {
    const double crept = first ? 0 : -states[i];
    const double rate = -std::expm1(-interval_s / times.at(i));
    states[i] = -(crept + (first ? 0 : rate * (before - crept)));
  }
}

/// Columns: the pieces of c, the plays, all creep times, the remainder.
NormalEquations equations_of(const Samples& samples, const std::vector<CurveStretch>& stretches,
                             double zone, double range) {
  const std::size_t pieces = stretches.size();
  const std::array<double, kCreepTimes> times = creep_times(samples);
  NormalEquations equations(pieces + kMaxPlays + kCreepTimes + 1);
  std::vector<double> row(equations.unknowns());
  double before = 0;
  for (const auto& sample : samples) {
    const double load = std::max(0.0, sample.load_counts - zone);
    const bool first = sample.interval_s <= 0;
    for (std::size_t i = 0; i < pieces; ++i) {
      const double begin = i == 0 ? -std::numeric_limits<double>::infinity() : stretches[i - 1].end;
      const double end =
          i + 1 == pieces ? std::numeric_limits<double>::infinity() : stretches[i].end;
      row[i] = std::clamp(sample.reading, begin, end) - (i == 0 ? 0 : begin);
    }
    for (std::size_t i = 0; i < kMaxPlays; ++i) {
      double& play = row[pieces + i];
      const double held = first ? 0 : -play;
      play = -std::clamp(held, std::max(0.0, load - kWidths.at(i) * range), load);
    }
    creep_on(std::span(row).subspan(pieces + kMaxPlays, kCreepTimes), times, sample.interval_s,
             before);
    // It grows with the first load to the full.
    row.back() = std::min(first ? 0 : row.back(), -std::min(1.0, load / (kWidths[0] * range)));
    before = load;
    equations.add(row, load);
  }
  for (std::size_t i = 0; i + 1 < pieces; ++i) {
    std::ranges::fill(row, 0);
    row[i] = kSmoothness * range * stretches[i].slope;
    row[i + 1] = -kSmoothness * range * stretches[i + 1].slope;
    equations.add(row, 0);
  }
  return equations;
}

/// Slopes and memory of a solution `x` of equations_of(), with two of its creep times.
MemoryFit fit_of(const std::vector<double>& x, std::size_t pieces, double range,
                 const std::array<double, kCreepTimes>& times, std::array<std::size_t, 2> creep) {
  MemoryFit fit;
  fit.slopes.assign(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(pieces));
  for (std::size_t i = 0; i < kMaxPlays; ++i) {
    if (x[pieces + i] > 0) fit.memory.plays.push_back({kWidths.at(i) * range, x[pieces + i]});
  }
  for (const std::size_t i : creep) {
    const double weight = x[pieces + kMaxPlays + i];
    if (weight > 0) fit.memory.creep.push_back({times.at(i), weight});
  }
  fit.remainder = x.back();
  return fit;
}

/// The best two creep times, or none, for a dead zone.
MemoryFit fit_at(const Samples& samples, const MemoryModelling& model, double zone, double range) {
  const std::size_t pieces = model.pieces.size();
  const bool with_memory = model.with_memory;
  const NormalEquations equations = equations_of(samples, model.pieces, zone, range);
  const std::array<double, kCreepTimes> times = creep_times(samples);
  MemoryFit best;
  best.squares = std::numeric_limits<double>::infinity();
  for (std::size_t fast = 0; fast < kCreepTimes; ++fast) {
    for (std::size_t slow = fast + 1; slow < kCreepTimes; ++slow) {
      std::vector<bool> allowed(equations.unknowns());
      for (std::size_t i = 0; i < pieces + kMaxPlays; ++i) allowed[i] = with_memory || i < pieces;
      allowed[pieces + kMaxPlays + fast] = allowed[pieces + kMaxPlays + slow] = with_memory;
      allowed.back() = model.with_remainder;
      const std::vector<double> x = equations.solve_non_negative(allowed);
      const double squares = equations.squares_at(x);
      if (squares < best.squares) {
        best = fit_of(x, pieces, range, times, {fast, slow});
        best.squares = squares;
        best.dead_zone = zone;
      }
      if (!with_memory) return best;
    }
  }
  return best;
}

}  // namespace

MemoryFit fit_memory(const std::vector<MemoryFinder::Sample>& samples,
                     const MemoryModelling& model) {
  const double range = range_of(samples);
  const auto at = [&](double zone) { return fit_at(samples, model, zone, range); };
  if (model.dead_zone) return at(*model.dead_zone);
  // A coarse search first: the squares may have several minima.
  constexpr int kCoarse = 20;
  const double step = kMostZone * range / kCoarse;
  int nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kCoarse; ++i) {
    const double squares = at(i * step).squares;
    if (squares >= least) continue;
    least = squares;
    nearest = i;
  }
  const double zone = least_of([&](double z) { return at(z).squares; },
                               std::max(0, nearest - 1) * step, (nearest + 1) * step, 1e-4 * range);
  MemoryFit none = at(0);
  MemoryFit fit = at(zone);
  return fit.squares < kZoneWins * none.squares ? fit : none;
}

double value_at(const MemoryFit& fit, const std::vector<CurveStretch>& pieces, double reading) {
  double value = 0;
  double begin = 0;
  for (std::size_t i = 0; i < pieces.size() && reading > begin; ++i) {
    const double end = i + 1 == pieces.size() ? reading : std::min(reading, pieces[i].end);
    value += fit.slopes[i] * (end - begin);
    begin = end;
  }
  return value;
}

}  // namespace pillarfield
