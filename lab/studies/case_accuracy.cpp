#include "lab/studies/case_accuracy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <optional>

#include "lab/studies/paper_oracle.h"

namespace pillarfield::hard_cases {
namespace {

using oracle::Exact;
using oracle::Force;
using oracle::SomeReadings;

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

}  // namespace

Outcome solve(const Example& example, Estimator estimator, Precision precision) {
  return precision == Precision::single_precision ? solve_in<float>(example, estimator)
                                                  : solve_in<double>(example, estimator);
}

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

double condition_as_assigned(const Example& example, Precision precision) {
  const std::optional<Known> known = known_of(example, Estimator::paper, precision);
  const bool four =
      known && std::ranges::all_of(known->usable, [](const auto& v) { return v.has_value(); });
  if (!four) return condition_of(example, Estimator::paper, precision);
  oracle::PaperChoice choice = oracle::paper_choices(known->usable).front();
  choice.i = 0;
  choice.j = 2;
  return condition_with(*known, choice);
}

}  // namespace pillarfield::hard_cases
