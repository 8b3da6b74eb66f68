// The hard cases, each by its name, for both estimators in float and in double.

#include "tests/kernels/hard_cases.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "pillarfield/status.h"
#include "tests/kernels/oracle.h"

namespace pillarfield::hard_cases {
namespace {

using oracle::Exact;
using oracle::Force;
using oracle::SomeReadings;

/// Solution of an example, in either precision.
struct Outcome {
  oracle::Force force;
  std::vector<double> outputs;  ///< force, direction, deviations and ends of the intervals
  int status = 0;
};

/// The input of an estimator, in units of the largest reading.
struct Known {
  SomeReadings usable;
  Exact unit = 0;    ///< counts; 0 where nothing is usable
  Exact hidden = 0;  ///< largest V of an inactive sensel
};

/// The usable readings of an example; unset if sensels are saturated or missing and fewer than
/// three are usable. The paper has no threshold and no saturation, and equates missing and inactive
/// sensels.
std::optional<Known> known_of(const Example& example, Estimator estimator, Precision precision) {
  const bool paper = estimator == Estimator::paper;
  Known known;
  int usable = 0;
  int odd = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    const double raw = example.raw[n];
    const bool missing = !(std::abs(raw) <= rounded(kMaxCounts, precision));
    const bool saturated = raw >= example.sensor.full_scale_counts.value_or(HUGE_VAL);
    odd += missing || saturated ? 1 : 0;
    if (missing || (saturated && !paper) || raw <= example.sensor.threshold_counts) continue;
    ++usable;
    known.usable[n] = raw;
    known.unit = std::max(known.unit, Exact(raw));
  }
  const bool opposite = usable == 2 && known.usable[0].has_value() == known.usable[2].has_value();
  if (odd > 0 && usable < 3 && (!paper || opposite)) return std::nullopt;
  if (known.unit == 0) return known;
  for (auto& reading : known.usable) {
    if (reading) reading = *reading / known.unit;
  }
  if (!paper) known.hidden = example.sensor.threshold_counts / known.unit;
  return known;
}

bool is_number(const Force& force) {
  return std::isfinite(static_cast<double>(force.shear_x + force.shear_y + force.normal));
}

/// Valid solutions for k = 1: several at ties of the paper's equations, least squares if these are
/// 0/0.
std::vector<Force> answers_to(const Known& known, Estimator estimator) {
  if (known.unit == 0 || estimator == Estimator::direct) {
    return {oracle::direct_force(known.usable, 1, known.hidden)};
  }
  std::vector<Force> answers;
  for (const auto& choice : oracle::paper_choices(known.usable)) {
    const Force force = oracle::paper_force(known.usable, 1, choice);
    answers.push_back(is_number(force) ? force : oracle::direct_force(known.usable, 1));
  }
  return answers;
}

Exact largest_difference(const Force& a, const Force& b) {
  return std::max({exact::abs(a.shear_x - b.shear_x), exact::abs(a.shear_y - b.shear_y),
                   exact::abs(a.normal - b.normal)});
}

/// Unit of an error, newtons.
Exact unit_of_error(Exact magnitude, Precision precision) {
  const bool single = precision == Precision::single_precision;
  const Exact epsilon = single ? Exact(std::numeric_limits<float>::epsilon())
                               : Exact(std::numeric_limits<double>::epsilon());
  const Exact least = single ? Exact(std::numeric_limits<float>::denorm_min())
                             : Exact(std::numeric_limits<double>::denorm_min());
  return std::max(epsilon * magnitude, least);
}

template <class Real>
Outcome solve_in(const Example& example, Estimator estimator) {
  std::array<Real, 4> raw{};
  std::ranges::transform(example.raw, raw.begin(), [](double v) { return static_cast<Real>(v); });
  const auto estimate = estimate_pillar<Real>(raw, example.sensor, estimator);
  const auto& [force, direction, status, deviations, interval] = estimate;
  Outcome outcome{{force.shear_x, force.shear_y, force.normal}, {}, status};
  for (const Real value :
       {force.shear_x, force.shear_y, force.normal, direction.magnitude, direction.theta,
        direction.phi, deviations.shear_x, deviations.shear_y, deviations.normal,
        interval.theta_low, interval.theta_high, interval.phi_low, interval.phi_high,
        interval.magnitude_low, interval.magnitude_high}) {
    outcome.outputs.push_back(double{value});
  }
  return outcome;
}

double condition_with(const Known& known, const oracle::PaperChoice& choice) {
  return oracle::condition_number(known.usable, [&](const SomeReadings& usable) {
    return oracle::paper_force(usable, 1, choice);
  });
}

Outcome solve(const Example& example, Estimator estimator, Precision precision) {
  return precision == Precision::single_precision ? solve_in<float>(example, estimator)
                                                  : solve_in<double>(example, estimator);
}

/// The largest error of a component of the force, against the oracle's answer to these readings, in
/// epsilons of the force's magnitude, or in smallest subnormal numbers where these are larger; 0
/// where the oracle has no answer: with sensels saturated or missing and fewer than three usable.
double error_of(const Outcome& outcome, const Example& example, Estimator estimator,
                Precision precision) {
  const std::optional<Known> known = known_of(example, estimator, precision);
  if (!known) return 0;
  const Exact scale = known->unit / example.sensor.counts_per_newton;
  double nearest = HUGE_VAL;
  for (const Force& answer : answers_to(*known, estimator)) {
    const Force expected = {answer.shear_x * scale, answer.shear_y * scale, answer.normal * scale};
    const Exact unit = unit_of_error(oracle::magnitude(answer) * scale, precision);
    const Exact error = largest_difference(outcome.force, expected) / unit;
    nearest = std::min(nearest, static_cast<double>(error));
  }
  return nearest;
}

/// The condition number of an example's force (oracle::condition_number); not a number where an
/// equation is 0/0, and 0 where the oracle has no answer.
double condition_of(const Example& example, Estimator estimator, Precision precision) {
  const std::optional<Known> known = known_of(example, estimator, precision);
  if (!known || known->unit == 0) return 0;
  if (estimator == Estimator::direct) {
    return oracle::condition_number(known->usable, [&](const SomeReadings& usable) {
      return oracle::direct_force(usable, 1, known->hidden);
    });
  }
  double worst = 0;
  for (const auto& choice : oracle::paper_choices(known->usable)) {
    const double condition = condition_with(*known, choice);
    if (!(condition <= worst)) worst = condition;
  }
  return worst;
}

/// Largest error of a component, in epsilons of the magnitude (docs/derivations/conditioning.md, C4
/// and C5).
double allowed_error(Estimator estimator, double condition) {
  if (estimator == Estimator::direct) return 3;
  return 42 + (std::isnan(condition) ? 0 : condition / 2);
}

std::string text_of(const Example& example) {
  return fmt::format("raw {}, k {}, threshold {}", fmt::join(example.raw, " "),
                     example.sensor.counts_per_newton, example.sensor.threshold_counts);
}

bool all_finite(const Outcome& outcome) {
  return std::ranges::all_of(outcome.outputs, [](double value) { return std::isfinite(value); });
}

/// The usable bits of the status byte, by the definition of usable.
int usable_bits(const Example& example, Precision precision) {
  int bits = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    const double raw = example.raw[n];
    const bool in_range = std::abs(raw) <= rounded(kMaxCounts, precision) &&
                          raw < example.sensor.full_scale_counts.value_or(HUGE_VAL);
    if (in_range && raw > example.sensor.threshold_counts) bits |= 1 << n;
  }
  return bits;
}

using Parameters = std::tuple<HardCase, Estimator, Precision>;

class HardCases : public testing::TestWithParam<Parameters> {};

TEST_P(HardCases, AreSolvedAsExactlyAsTheirConditionAllows) {
  const auto& [hard_case, estimator, precision] = GetParam();
  for (const Example& example : hard_case.examples(precision)) {
    SCOPED_TRACE(text_of(example));
    const Outcome outcome = solve(example, estimator, precision);
    const double condition = condition_of(example, estimator, precision);
    EXPECT_LE(error_of(outcome, example, estimator, precision),
              allowed_error(estimator, condition));
  }
}

TEST_P(HardCases, HaveFiniteOutputsAndTheirStatus) {
  const auto& [hard_case, estimator, precision] = GetParam();
  for (const Example& example : hard_case.examples(precision)) {
    SCOPED_TRACE(text_of(example));
    const Outcome outcome = solve(example, estimator, precision);
    EXPECT_TRUE(all_finite(outcome));
    EXPECT_EQ(outcome.status & hard_case.status, hard_case.status);
    EXPECT_EQ(outcome.status & status::kUsable, usable_bits(example, precision));
  }
}

std::string name_of_test(const testing::TestParamInfo<Parameters>& test) {
  const auto& [hard_case, estimator, precision] = test.param;
  return fmt::format("{}_{}_{}", hard_case.name, name_of(estimator),
                     precision == Precision::single_precision ? "float" : "double");
}

INSTANTIATE_TEST_SUITE_P(Of, HardCases,
                         testing::Combine(testing::ValuesIn(hard_cases()),
                                          testing::Values(Estimator::direct, Estimator::paper),
                                          testing::Values(Precision::single_precision,
                                                          Precision::double_precision)),
                         name_of_test);

/// Any reading: out of range, at a limit, or ordinary.
double any_reading(std::mt19937_64& engine) {
  constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kLeast = std::numeric_limits<float>::denorm_min();
  constexpr double kSmall = std::numeric_limits<float>::min();
  constexpr double kMost = std::numeric_limits<float>::max();
  constexpr std::array<double, 20> kOdd = {
      kNotANumber, kInfinite, -kInfinite, 0,     -0.0,   kLeast, -kLeast, 1e33, -1e33, 10,
      255,         -1,        kSmall,     kMost, -kMost, 1e30,   1e-30,   1,    1,     1 + 1e-6};
  const std::size_t pick = engine() % 30;
  if (pick < kOdd.size()) return kOdd[pick];
  return std::exp(static_cast<double>(engine() % 1000) / 50 - 8);
}

TEST(AllHardCases, AnyReadingsHaveFiniteOutputs) {
  std::mt19937_64 engine(71);
  for (int i = 0; i < 200'000; ++i) {
    Example example;
    for (double& raw : example.raw) raw = any_reading(engine);
    example.sensor.counts_per_newton = i % 3 == 0 ? kMinCountsPerNewton : 320;
    example.sensor.threshold_counts = i % 2 == 0 ? 0 : 10;
    example.sensor.dead_zone_counts = i % 5 == 0 ? 7 : 0;
    if (i % 4 == 0) example.sensor.full_scale_counts = 255;
    for (const Estimator estimator : {Estimator::direct, Estimator::paper}) {
      for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
        const Outcome outcome = solve(example, estimator, precision);
        ASSERT_TRUE(all_finite(outcome)) << text_of(example);
        if (estimator == Estimator::direct) {
          ASSERT_GE(outcome.outputs[2], 0) << text_of(example);
        }
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield::hard_cases
