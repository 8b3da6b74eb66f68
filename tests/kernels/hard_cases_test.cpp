// The hard cases, each by its name, for both estimators in float and in double.

#include "lab/studies/hard_cases.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <tuple>

#include "lab/studies/case_accuracy.h"
#include "pillarfield/status.h"

namespace pillarfield::hard_cases {
namespace {

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

TEST(AllHardCases, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const HardCase& hard_case : hard_cases()) {
    EXPECT_TRUE(names.insert(hard_case.name).second) << hard_case.name;
  }
}

/// Any reading: out of range, at a limit, or ordinary.
double any_reading(std::mt19937_64& engine) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kLeast = std::numeric_limits<float>::denorm_min();
  constexpr std::array<double, 12> kOdd = {kNan,    kInfinity, -kInfinity, 0,  -0.0, kLeast,
                                           -kLeast, 1e33,      -1e33,      10, 255,  -1};
  const std::size_t pick = engine() % 24;
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
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield::hard_cases
