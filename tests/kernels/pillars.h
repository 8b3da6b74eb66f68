#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"
#include "tests/kernels/oracle.h"

/// One test body for the C++ forms of kernels/pillar: its types by precision. The functions that
/// take one of these types are found by argument-dependent lookup.
/// Pillars for tests: sensels in any state, solved pillars, and random ones.
namespace pillarfield {

struct Single {
  using Real = float;
  using Force = single_precision::Force;
  using Readings = single_precision::Readings;
  using Sensel = single_precision::Sensel;
  using Pillar = single_precision::Pillar;
  using Diagonals = single_precision::Diagonals;
  using ParitySum = single_precision::ParitySum;
  using ForceScale = single_precision::ForceScale;
  static Sensel raw_sensel(Real raw) { return single_precision::raw_sensel(raw); }
};

struct Double {
  using Real = double;
  using Force = double_precision::Force;
  using Readings = double_precision::Readings;
  using Sensel = double_precision::Sensel;
  using Pillar = double_precision::Pillar;
  using Diagonals = double_precision::Diagonals;
  using ParitySum = double_precision::ParitySum;
  using ForceScale = double_precision::ForceScale;
  static Sensel raw_sensel(Real raw) { return double_precision::raw_sensel(raw); }
};

template <class Precision>
using RealOf = typename Precision::Real;
template <class Precision>
using ForceOf = typename Precision::Force;
template <class Precision>
using SenselOf = typename Precision::Sensel;
template <class Precision>
using PillarOf = typename Precision::Pillar;

using Precisions = testing::Types<Single, Double>;

struct PrecisionNames {
  template <class Precision>
  // GoogleTest's name for it. NOLINTNEXTLINE(readability-identifier-naming)
  static std::string GetName(int /*index*/) {
    return std::is_same_v<Precision, Single> ? "float" : "double";
  }
};

/// The spacing of Real at x.
template <class Real>
double ulp_at(oracle::Exact x) {
  using Limits = std::numeric_limits<Real>;
  const double smallest = Limits::denorm_min();
  if (x == 0) return smallest;
  return std::max(smallest,
                  std::ldexp(1.0, std::ilogb(static_cast<double>(x)) + 1 - Limits::digits));
}

/// Error of `actual`, in units in the last place of `scale`.
template <class Real>
double ulps(Real actual, oracle::Exact expected, oracle::Exact scale) {
  return static_cast<double>(exact::abs(oracle::Exact(actual) - expected)) / ulp_at<Real>(scale);
}

/// The largest error of the three components, in ULP of the force's magnitude.
template <class Precision>
double force_ulps(const ForceOf<Precision>& actual, const oracle::Force& expected) {
  using Real = RealOf<Precision>;
  const oracle::Exact scale = oracle::magnitude(expected);
  return std::max({ulps<Real>(actual.shear_x, expected.shear_x, scale),
                   ulps<Real>(actual.shear_y, expected.shear_y, scale),
                   ulps<Real>(actual.normal, expected.normal, scale)});
}

template <class Force>
oracle::Force to_exact(const Force& force) {
  return {force.shear_x, force.shear_y, force.normal};
}

enum class State { usable, inactive, missing, saturated };

inline constexpr std::array<State, 4> kStates = {State::usable, State::inactive, State::missing,
                                                 State::saturated};

using States = std::array<State, 4>;

/// All 256 combinations of states.
inline std::array<States, 256> all_states() {
  std::array<States, 256> all{};
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {kStates[i % 4], kStates[i / 4 % 4], kStates[i / 16 % 4], kStates[i / 64]};
  }
  return all;
}

/// "usable inactive missing saturated", say.
inline std::string name_of(const States& states) {
  static constexpr std::array<const char*, 4> kNames = {"usable", "inactive", "missing",
                                                        "saturated"};
  std::string name;
  for (const State state : states) {
    name += std::string(name.empty() ? "" : " ") + kNames[static_cast<std::size_t>(state)];
  }
  return name;
}

/// A sensel in a state as its stages return it; `reading` is positive.
template <class Precision>
SenselOf<Precision> sensel_in(State state, RealOf<Precision> reading) {
  using Real = RealOf<Precision>;
  const auto raw = Precision::raw_sensel(state == State::inactive ? Real{0} : reading);
  if (state == State::missing) return classify(apply_mask(raw, Real{0}), Real{0});
  if (state == State::saturated) return classify(mark_saturated(raw, reading), Real{0});
  return classify(raw, Real{0});
}

template <class Precision>
using FourReadings = std::array<RealOf<Precision>, 4>;

template <class Precision>
PillarOf<Precision> pillar_in(const States& states, const FourReadings<Precision>& readings) {
  return {
      sensel_in<Precision>(states[0], readings[0]), sensel_in<Precision>(states[1], readings[1]),
      sensel_in<Precision>(states[2], readings[2]), sensel_in<Precision>(states[3], readings[3])};
}

/// Readings above `threshold` are usable and the others inactive.
template <class Precision>
PillarOf<Precision> pillar_of(const FourReadings<Precision>& readings,
                              RealOf<Precision> threshold = 0) {
  return {classify(Precision::raw_sensel(readings[0]), threshold),
          classify(Precision::raw_sensel(readings[1]), threshold),
          classify(Precision::raw_sensel(readings[2]), threshold),
          classify(Precision::raw_sensel(readings[3]), threshold)};
}

/// The oracle's input: usable readings.
template <class Pillar>
oracle::SomeReadings usable_readings(const Pillar& pillar) {
  oracle::SomeReadings some;
  const std::array sensels = {pillar.s1, pillar.s2, pillar.s3, pillar.s4};
  for (std::size_t n = 0; n < 4; ++n) {
    if (sensels[n].usable) some[n] = sensels[n].reading;
  }
  return some;
}

/// A pillar and its results.
template <class Precision>
struct Solved {
  typename Precision::Diagonals diagonals;
  typename Precision::ParitySum sum;
  typename Precision::ForceScale scale;
  ForceOf<Precision> force;
  int status;

  [[nodiscard]] ForceOf<Precision> low() const { return force_at(diagonals, sum.low, scale); }
  [[nodiscard]] ForceOf<Precision> high() const { return force_at(diagonals, sum.high, scale); }
};

template <class Precision>
Solved<Precision> solve(const PillarOf<Precision>& pillar, double k,
                        double segment_point = kSegmentPoint) {
  using Real = RealOf<Precision>;
  Solved<Precision> solved{};
  solved.diagonals = pillar_diagonals(pillar);
  solved.sum = parity_sum(solved.diagonals, static_cast<Real>(segment_point));
  solved.scale = {static_cast<Real>(1 / (2 * std::numbers::sqrt2_v<long double> * k)),
                  static_cast<Real>(1 / (2 * static_cast<long double>(k)))};
  solved.force = direct_force(solved.diagonals, solved.sum, solved.scale);
  solved.status = direct_status(pillar, solved.diagonals, solved.sum, Real{0});
  return solved;
}

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  /// Log-uniform.
  double decades(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  std::size_t below(std::size_t count) { return engine_() % count; }
  double normal() { return normal_(engine_); }

  /// A force of `magnitude` that presses, uniform over the hemisphere.
  double_precision::Force force(double magnitude) {
    const double cosine = uniform(0, 1);
    const double sine = std::sqrt(1 - cosine * cosine);
    const double phi = uniform(-std::numbers::pi, std::numbers::pi);
    return {-magnitude * sine * std::cos(phi), -magnitude * sine * std::sin(phi),
            magnitude * cosine};
  }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

/// The oracle's readings of a force, rounded; negative where the pillar lifts.
template <class Precision>
FourReadings<Precision> rounded_readings(const double_precision::Force& force, double k) {
  const oracle::Readings exact_readings = oracle::readings_of(to_exact(force), k);
  FourReadings<Precision> readings;
  for (std::size_t n = 0; n < 4; ++n) {
    readings[n] = static_cast<RealOf<Precision>>(exact_readings[n]);
  }
  return readings;
}

template <class Real>
int count_positive(const std::array<Real, 4>& readings) {
  return static_cast<int>(std::ranges::count_if(readings, [](Real v) { return v > 0; }));
}

}  // namespace pillarfield
