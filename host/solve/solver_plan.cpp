#include "pillarfield/solver_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "skin/limits.h"
#include "solve/plan_settings.h"
#include "solve/sensor_corrections.h"

namespace pillarfield {
namespace {

/// Throws Error if a value lies outside its range.
void require_within(const char* name, double value, const Range& range, std::string_view where) {
  if (range.contains(value)) return;
  throw Error(where, fmt::format("{} is {}", name, value),
              fmt::format("it must lie in {}", range.bounds()));
}

/// Largest RMS error of the polynomial of a response curve, of the largest load.
constexpr double kMaxCurveMisfit = 0.01;

/// Throws Error if the kernel's polynomial does not follow a response curve.
void check_curve(const ResponseCurve& curve, std::string_view where) {
  if (curve.empty()) return;
  const double misfit = curve_polynomial(curve).rms_counts / curve.loads.back();
  if (misfit <= kMaxCurveMisfit) return;
  throw Error(
      where,
      fmt::format("the response curve is bent too sharply: its polynomial is off by {:.2g} % "
                  "of the largest load",
                  100 * misfit),
      fmt::format("give a curve that a polynomial of degree {} follows to 1 %", PF_CURVE_TERMS));
}

/// Root mean square of the noise of the sensels that are not masked.
double mean_noise(const Calibration& calibration) {
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < calibration.noise.size(); ++i) {
    if (!is_good(calibration, i)) continue;
    squares += double{calibration.noise[i]} * calibration.noise[i];
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count));
}

/// Standard deviation of a reading, counts: from the noise plane, else from the plan; empty if
/// neither is given.
std::optional<double> given_noise(const SolverPlan& plan) {
  if (!plan.calibration.noise.empty()) return mean_noise(plan.calibration);
  if (plan.noise_counts) return reading_noise(plan);
  return std::nullopt;
}

/// The noise of a reading, counts, with the residual offset of the calibration (E9).
double with_offset(const SolverPlan& plan, double noise) {
  const ResidualError residual = plan.calibration.effects.residual.value_or(ResidualError{});
  return residual.offset_counts == 0 ? noise : std::hypot(noise, residual.offset_counts);
}

/// Throws Error if a plan of sensels without pillars asks for what only pillars have.
void check_layout(const SolverPlan& plan, std::string_view where) {
  if (plan.skin.has_pillars()) return;
  const SensorEffects& effects = plan.calibration.effects;
  const auto refuse = [&](bool asked, const char* what) {
    if (!asked) return;
    throw Error(where, fmt::format("the skin has no pillars, but the plan has {}", what),
                "leave it out, or give the skin the layout pillars");
  };
  refuse(estimator_of(plan) != Estimator::direct,
         plan.estimator == Estimator::paper ? "the paper's estimator" : "the estimator contact");
  refuse(plan.parity_tolerance_counts.has_value(), "a parity test");
  const FrictionKnowledge& friction = plan.friction;
  const FrictionKnowledge unknown;
  refuse(friction.given || friction.bound || friction.median != unknown.median ||
             friction.spread != unknown.spread,
         "a friction coefficient");
  refuse(plan.angles, "magnitude and angles of shear force");
  refuse(names_of(effects) != names_of(without_pillars(effects)), "an effect of pillars");
}

/// Throws Error if a number is out of range.
void check_numbers(const SolverPlan& plan, std::string_view where) {
  require_within("segment_point", plan.segment_point, {0, 1, true}, where);
  if (plan.baseline_rate) require_within("baseline_rate", *plan.baseline_rate, {0, 1, true}, where);
  for (const PlanSetting& setting : kPlanSettings) {
    const std::optional<double> value = setting.number.get(plan);
    if (value) require_within(setting.name, *value, setting.range, where);
  }
}

/// Sets a member to a value that was given.
template <class Member, class Value>
void set_given(Member& member, const std::optional<Value>& value) {
  if (value) member = *value;
}

/// Number of frames over which the tare update may be spread: a hundredth of the time constant, and
/// without the divisors 2, 3 and 5 of usual frame rates, so that hum of 50 or 60 Hz does not stand
/// still from turn to turn.
int baseline_interval(double time_constant_frames) {
  constexpr double kTurnsInTimeConstant = 100;
  const double most = time_constant_frames / kTurnsInTimeConstant;
  int interval = static_cast<int>(std::fmin(std::fmax(most, 1), kBaselineIntervals.high));
  while (std::gcd(interval, 2 * 3 * 5) != 1) --interval;
  return interval;
}

/// Threshold over standard deviation of a reading, assumed where no noise is given.
constexpr double kThresholdDeviations = 4;

}  // namespace

void check(const FrictionKnowledge& friction, std::string_view where) {
  require_within("the median of the friction's prior", friction.median, kFrictions, where);
  require_within("the spread of the friction's prior", friction.spread, kPriorSpread, where);
  if (friction.given) require_within("the friction", *friction.given, kFrictions, where);
  if (friction.bound) {
    require_within("the bound of the friction", *friction.bound, kFrictionBound, where);
  }
}

const char* name_of(Estimator estimator) { return name_in(kEstimators, estimator); }

void apply(const PlanSettings& settings, SolverPlan& plan) {
  for (const PlanSetting& setting : kPlanSettings) {
    if (settings.*setting.member) setting.number.set(plan, settings.*setting.member);
  }
  for (const PlanOutput& output : kPlanOutputs) {
    set_given(plan.*output.flag, settings.*output.member);
  }
  set_given(plan.estimator, settings.estimator);
  set_given(plan.skin.layout, settings.layout);
  set_given(plan.skin.sensel_pitch_mm, settings.sensel_pitch_mm);
  plan.skin.stated.layout |= settings.layout.has_value();
  plan.skin.stated.sensel_pitch |= settings.sensel_pitch_mm.has_value();
  plan.skin.stated.counts_per_newton |= settings.counts_per_newton.has_value();
  if (!settings.friction_prior.empty()) {
    plan.friction.median = settings.friction_prior[0];
    plan.friction.spread = settings.friction_prior[1];
  }
  if (settings.unrelated_frames) plan.friction.memory = !*settings.unrelated_frames;
}

void set_outputs(const std::vector<std::string>& words, PlanSettings& settings) {
  for (const PlanOutput& output : kPlanOutputs) {
    settings.*output.member = std::ranges::find(words, output.name) != words.end();
  }
}

void check(const PlanSettings& settings, std::string_view where) {
  for (const PlanSetting& setting : kPlanSettings) {
    const std::optional<double>& value = settings.*setting.member;
    if (!value || setting.range.contains(*value)) continue;
    throw Error(where, fmt::format("{} is {}", setting.name, *value),
                fmt::format("it must be {}", setting.range.text()));
  }
}

Estimator estimator_of(const SolverPlan& plan) {
  return plan.estimator.value_or(plan.skin.has_pillars() ? Estimator::contact : Estimator::direct);
}

void check(const SolverPlan& plan, std::string_view where) {
  check(plan.skin, where);
  check_layout(plan, where);
  check(plan.calibration, plan.skin, where, plan.sensel_type);
  check(plan.friction, where);
  check_numbers(plan, where);
  if (plan.skin.power_law && !plan.calibration.effects.curve.empty()) {
    throw Error(where, "the skin has a power law and a response curve", "give one of the two");
  }
  check_curve(plan.calibration.effects.curve, where);
  if (!plan.uncertainty) return;
  if (plan.estimator == Estimator::paper) {
    throw Error(where, "the paper's estimator has no uncertainty",
                "use the estimator direct or contact");
  }
  if (!plan.noise_counts && plan.calibration.noise.empty()) {
    throw Error(where, "uncertainty needs the noise of the sensels",
                "give noise_counts, or a calibration with a noise plane");
  }
}

void set_baseline(SolverPlan& plan, double time_constant_s) {
  plan.baseline_rate = -std::expm1(-plan.frame_interval_s / time_constant_s);
  constexpr double kReleaseShare = 2.5;  // a fortieth is a hundredth of it
  plan.baseline_interval = baseline_interval(
      std::min(time_constant_s, kReleaseShare * plan.release_time_s) / plan.frame_interval_s);
}

double baseline_turn_rate(const SolverPlan& plan) {
  const double rate = plan.baseline_rate.value_or(0);
  if (plan.baseline_interval == 1) return rate;
  return -std::expm1(plan.baseline_interval * std::log1p(-rate));
}

double reading_noise(const SolverPlan& plan) {
  const double noise = plan.noise_counts.value_or(0);
  const double rounding = plan.sensel_type == SenselType::f32 ? 0 : 1.0 / 12;
  return std::sqrt(noise * noise + rounding);
}

double reading_noise_n(const SolverPlan& plan) {
  const double assumed = plan.skin.threshold_counts / kThresholdDeviations;
  return with_offset(plan, given_noise(plan).value_or(assumed)) / plan.skin.counts_per_newton;
}

double hidden_normal_n(const Skin& skin) {
  return force_scale(skin).normal * skin.threshold_counts;
}

double region_margin(const SolverPlan& plan) {
  const std::optional<double> noise = given_noise(plan);
  return noise ? region_margin(with_offset(plan, *noise)) : 0;
}

double region_margin(double noise_counts) {
  // Parity predicts V_p + V_q - V_r, from three readings with independent noise.
  return 5 * std::sqrt(3.0) * noise_counts;
}

}  // namespace pillarfield
