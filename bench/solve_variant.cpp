#include "bench/solve_variant.h"

#include <fmt/format.h>

#include "bench/variants.h"

namespace pillarfield::bench {
namespace {

/// Stages of the uncalibrated sensor, then of the calibrated one: each group shares its frames.
constexpr std::string_view kStages[] = {"none", "angles", "uncertainty", "calibration", "all"};
constexpr SenselType kTypes[] = {SenselType::u8, SenselType::u16, SenselType::f32};
constexpr Estimator kEstimators[] = {Estimator::direct, Estimator::paper};
constexpr Arithmetic kArithmetics[] = {Arithmetic::device_float, Arithmetic::host_double};

const char* name_of(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::device_float ? "float" : "double";
}

const char* short_name_of(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return "u8";
    case SenselType::u16:
      return "u16";
    case SenselType::f32:
      break;
  }
  return "f32";
}

bool exists(const SolveVariant& variant) {
  const bool wants_uncertainty = variant.stage == "uncertainty" || variant.stage == "all";
  return !(variant.estimator == Estimator::paper && wants_uncertainty);
}

void add_calibration(SolverPlan& plan) {
  for (const char* const stage : {"tare", "gain", "dead_zone", "mask"}) add_stage(plan, stage);
}

}  // namespace

std::string name_of(const SolveVariant& variant) {
  return fmt::format("{}/{}/{}/{}", pillarfield::name_of(variant.estimator),
                     name_of(variant.arithmetic), short_name_of(variant.type), variant.stage);
}

std::vector<SolveVariant> solve_variants() {
  std::vector<SolveVariant> all;
  for (const SenselType type : kTypes) {
    for (const std::string_view stage : kStages) {
      for (const Estimator estimator : kEstimators) {
        for (const Arithmetic arithmetic : kArithmetics) {
          const SolveVariant variant = {estimator, arithmetic, type, stage};
          if (exists(variant)) all.push_back(variant);
        }
      }
    }
  }
  return all;
}

double count_scale(SenselType type) { return type == SenselType::u16 ? 16 : 1; }

SolverPlan plan_of(const SolveVariant& variant, std::uint32_t pillars_a_side) {
  SolverPlan plan = bare_plan(pillars_a_side, variant.type);
  plan.estimator = variant.estimator;
  if (variant.stage == "calibration") {
    add_calibration(plan);
  } else {
    add_stage(plan, variant.stage);
  }
  const double scale = count_scale(variant.type);
  plan.skin.counts_per_newton *= scale;
  plan.skin.threshold_counts = kSensorThresholdCounts * scale;
  plan.noise_counts = kSensorNoiseCounts * scale;
  return plan;
}

}  // namespace pillarfield::bench
