#pragma once

#include <array>
#include <optional>
#include <type_traits>

#include "pillarfield/solver_plan.h"
#include "pillarfield/tuning.h"
#include "skin/force_scale.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// What is known of the sensels of one pillar; all in counts of a reading.
struct PillarSensor {
  double counts_per_newton = 1;
  double threshold_counts = 0;
  double dead_zone_counts = 0;
  std::optional<double> full_scale_counts;
  double noise_counts = 0;  ///< standard deviation; 0: not known
};

/// The functions of kernels/pillar in the precision of Real.
template <class Real>
struct PillarMaths;

#define PILLARFIELD_PILLAR_MATHS(real, space)                              \
  template <>                                                              \
  struct PillarMaths<real> {                                               \
    using Sensel = space::Sensel;                                          \
    using Pillar = space::Pillar;                                          \
    using Force = space::Force;                                            \
    using ForceScale = space::ForceScale;                                  \
    using Direction = space::Direction;                                    \
    using DirectionInterval = space::DirectionInterval;                    \
    static Sensel raw(real reading) { return space::raw_sensel(reading); } \
  };
PILLARFIELD_PILLAR_MATHS(float, single_precision)
PILLARFIELD_PILLAR_MATHS(double, double_precision)
#undef PILLARFIELD_PILLAR_MATHS

/// All that is solved of one pillar.
template <class Real>
struct PillarEstimate {
  typename PillarMaths<Real>::Force force;                 ///< N
  typename PillarMaths<Real>::Direction direction;         ///< N, rad
  int status;                                              ///< the status byte
  typename PillarMaths<Real>::Force deviations;            ///< N; of the direct estimate
  typename PillarMaths<Real>::DirectionInterval interval;  ///< N, rad; of the direct estimate
};

/// A raw reading through the stages of kernels/pillar/sensel.h.
template <class Real>
typename PillarMaths<Real>::Sensel prepare_sensel(Real raw, const PillarSensor& sensor) {
  auto sensel = reject_absurd(PillarMaths<Real>::raw(raw), static_cast<Real>(kMaxCounts));
  if (sensor.full_scale_counts) {
    sensel = mark_saturated(sensel, static_cast<Real>(*sensor.full_scale_counts));
  }
  sensel = classify(sensel, static_cast<Real>(sensor.threshold_counts));
  return fill_dead_zone(sensel, static_cast<Real>(sensor.dead_zone_counts));
}

/// One pillar from the raw readings of its sensels 1 to 4, counts, in float or double: the very
/// functions that the kernels call. `segment_point` is that of SolverPlan.
template <class Real>
PillarEstimate<Real> estimate_pillar(const std::array<Real, 4>& raw, const PillarSensor& sensor,
                                     Estimator estimator, double segment_point = kSegmentPoint) {
  const typename PillarMaths<Real>::Pillar pillar = {
      prepare_sensel(raw[0], sensor), prepare_sensel(raw[1], sensor),
      prepare_sensel(raw[2], sensor), prepare_sensel(raw[3], sensor)};
  const ForceScale exact_scale = force_scale(sensor.counts_per_newton);
  const typename PillarMaths<Real>::ForceScale scale = {static_cast<Real>(exact_scale.shear),
                                                        static_cast<Real>(exact_scale.normal)};
  const auto noise = static_cast<Real>(sensor.noise_counts);
  const auto doubt = static_cast<Real>(region_doubt(sensor.noise_counts));
  const auto diagonals = pillar_diagonals(pillar);
  const auto point = static_cast<Real>(segment_point);
  const auto sum = parity_sum(diagonals, point);
  PillarEstimate<Real> estimate{};
  estimate.force = estimator == Estimator::paper ? paper_force(pillar, diagonals, sum, scale)
                                                 : direct_force(diagonals, sum, scale);
  estimate.direction = direction_of(estimate.force);
  estimate.status = direct_status(pillar, diagonals, sum, doubt);
  estimate.deviations =
      force_deviations(pillar, diagonals, sum, {noise, noise, noise, noise}, point, scale);
  const auto direct = direction_of(direct_force(diagonals, sum, scale));
  estimate.interval = direction_interval(pillar, diagonals, sum, direct, scale);
  return estimate;
}

}  // namespace pillarfield
