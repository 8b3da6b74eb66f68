#include "solve/sensor_corrections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pillarfield {
namespace {

/// Sensels of a square patch that is large enough for the inverse of the largest leak, and the
/// terms of its series.
constexpr int kPatch = 32;
constexpr int kMiddle = kPatch / 2;
constexpr int kTerms = 200;
constexpr double kLeastTerm = 1e-9;

using Patch = std::vector<double>;

/// The patch repeats.
std::size_t place_of(int row, int col) {
  constexpr std::size_t kRowLength = kPatch;
  const auto wrapped = [](int i) { return static_cast<std::size_t>((i + kPatch) % kPatch); };
  return wrapped(row) * kRowLength + wrapped(col);
}

double at(const Patch& patch, int row, int col) { return patch[place_of(row, col)]; }

/// Leak that the place of a patch receives from the sensels beside it.
double sensel_receives(const Patch& from, int row, int col, const SenselLeak& leak) {
  double sum = 0;
  for (const int step : {-1, 1}) {
    sum += leak_from(leak, row, step) * at(from, row + step, col);
    sum += leak_from(leak, col, step) * at(from, row, col + step);
  }
  return sum;
}

/// The response of the inverse of a leak to its middle, (I + K)^-1 as a series, which converges up
/// to kMostSenselLeak. By symmetry it holds the weights with which the middle is corrected.
Patch inverse_of(const SenselLeak& leak) {
  Patch term(static_cast<std::size_t>(kPatch) * kPatch);
  term[place_of(kMiddle, kMiddle)] = 1;
  Patch inverse = term;
  Patch next = term;
  for (int i = 0; i < kTerms; ++i) {
    for (int row = 0; row < kPatch; ++row) {
      for (int col = 0; col < kPatch; ++col) {
        next[place_of(row, col)] = -sensel_receives(term, row, col, leak);
      }
    }
    term.swap(next);
    double largest = 0;
    for (std::size_t place = 0; place < term.size(); ++place) {
      inverse[place] += term[place];
      largest = std::max(largest, std::abs(term[place]));
    }
    if (largest < kLeastTerm) break;
  }
  return inverse;
}

}  // namespace

double_precision::LeakTaps leak_taps(const SenselLeak& leak) {
  const Patch inverse = inverse_of(leak);
  const auto tap = [&](int down, int right) {
    return at(inverse, kMiddle + down, kMiddle + right);
  };
  // The middle is an even place: its neighbour inside the pillar is below and to the right.
  double_precision::LeakTaps taps = {tap(0, 0), tap(0, 1),  tap(0, -1),
                                     tap(1, 1), tap(1, -1), tap(-1, -1)};
  const double whole = 1 / (1 + 2 * (leak.inside + leak.across));
  const double cut = taps.self + 2 * (taps.inside + taps.across + taps.mixed) + taps.both_inside +
                     taps.both_across;
  taps.self += whole - cut;
  return taps;
}

PillarTaps pillar_leak_taps(const PillarLeak& leak) {
  // A wave with the cosines x and y from pillar to pillar is multiplied by `response`, and by the
  // weights whole + edge * by_edge + corner * by_corner.
  constexpr int kWaves = 8;  // along each axis: sums of these polynomials are exact
  const double whole = 1 / (1 + 4 * (leak.edge + leak.corner));
  double ee = 0;  // normal equations
  double ec = 0;
  double cc = 0;
  double er = 0;
  double cr = 0;
  for (int i = 0; i < kWaves * kWaves; ++i) {
    const int row = i / kWaves;
    const double x = std::cos(2 * std::numbers::pi * row / kWaves);
    const double y = std::cos(2 * std::numbers::pi * (i % kWaves) / kWaves);
    const double response = 1 + 2 * leak.edge * (x + y) + 4 * leak.corner * x * y;
    const double by_edge = response * (2 * (x + y) - 4);
    const double by_corner = response * (4 * x * y - 4);
    const double rest = 1 - whole * response;
    ee += by_edge * by_edge;
    ec += by_edge * by_corner;
    cc += by_corner * by_corner;
    er += by_edge * rest;
    cr += by_corner * rest;
  }
  const double determinant = ee * cc - ec * ec;
  const double edge = (er * cc - cr * ec) / determinant;
  const double corner = (cr * ee - er * ec) / determinant;
  return {whole - 4 * (edge + corner), edge, corner};
}

single_precision::MemoryModel memory_model(const SenselMemory& memory, double frame_interval_s) {
  single_precision::MemoryModel model{};
  model.plays = static_cast<int>(memory.plays.size());
  model.creeps = static_cast<int>(memory.creep.size());
  double slope = 1;    // of the loading curve
  double reading = 0;  // on it, at the width of the play
  double before = 0;
  for (std::size_t i = 0; i < memory.plays.size(); ++i) {
    const Play& play = memory.plays[i];
    reading += slope * (play.width_counts - before);
    before = play.width_counts;
    const double next = slope + play.weight;
    model.play_width[i] = static_cast<float>(reading);
    model.play_weight[i] = static_cast<float>(1 / next - 1 / slope);
    slope = next;
  }
  for (std::size_t i = 0; i < memory.creep.size(); ++i) {
    model.creep_rate[i] =
        static_cast<float>(-std::expm1(-frame_interval_s / memory.creep[i].time_s));
    model.creep_decay[i] = static_cast<float>(frame_interval_s / memory.creep[i].time_s);
    model.creep_weight[i] = static_cast<float>(memory.creep[i].weight);
  }
  return model;
}

}  // namespace pillarfield
