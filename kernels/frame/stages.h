/* The stages of the solve, for the device and, as C++, for the host.
 *
 * A program defines the macro of each stage that its plan names; other stages are not compiled. C++
 * compiles all of them and tests PF_NAMED at run time; so do the files of kernels/frame, which C++
 * compiles with PF_LANES. stage_table.h lists stages and constants.
 *
 * Where a new stage goes:
 * - Correction of one sensel: in correct_sensel, its effect on noise in corrected_noise. A
 *   parameter per sensel is a calibration plane and a member of Correction.
 * - Quantity of one pillar: in solve_pillar. Its results are lines of result_planes.h.
 * - Stage with neighbours: between linear_sensel and active_sensel if it reads the sensels next to
 *   a pillar (neighbours.h); else an entry point of its own before solve_frame.cl (find_wires.cl)
 * or after it (correct_forces.cl, follow_baseline.cl).
 * - Stage with state: planes of states that solve_frame.cl updates (memory.h), or a plane that an
 *   entry point updates for the next frame. Frames then wait for each other on the device.
 * Idle blocks are skipped: activation_thresholds() and threshold_of_sensel() must include a stage
 * that moves small readings across the threshold. */

#ifdef __cplusplus
#ifdef PF_LANES
#define PF_NAMED(stage) named.stage
#define PF_NUMBER(name) (stages->name)
#else
#define PF_NAMED(stage) stages.stage
#define PF_NUMBER(name) stages.name
#endif
#ifdef PF_WHOLE
#define PF_SATURATION
#define PF_PARITY_TEST
#else
#include "kernels/define_stages.h" /* made from stage_table.h */
#define PF_AFTER_TARE PF_NAMED(wires_after_tare)
#define PF_WIRES_ACT(after_tare) (PF_NAMED(wires) && PF_AFTER_TARE == (after_tare))
#endif

/* The stages that a plan names, and its numbers. */
struct NamedStages : PlanNumbers {
#define PF_MEMBER(name, macro, place, state, named) bool name;
  PF_STAGES(PF_MEMBER)
#undef PF_MEMBER
};
#ifdef PF_LANES
NamedStages named;
typedef const PlanNumbers* Stages;
#else
typedef NamedStages Stages;
#endif
#else
#define PF_NAMED(stage) 1
#define PF_NUMBER(name) (stages->name)
#ifdef PF_WIRES_AFTER_TARE
#define PF_AFTER_TARE 1
#else
#define PF_AFTER_TARE 0
#endif
#define PF_WIRES_ACT(after_tare) (PF_AFTER_TARE == (after_tare))
typedef constant PlanNumbers* Stages; /* A program has macros for the stages. */
#endif
/* A number of a plan in every lane of a type, where `stages` is known. */
#define PF_VALUE(type, name) PF_CONSTANT(type, PF_NUMBER(name))

/* Calibration of a sensel; members of stages that are not named are not read. */
typedef struct {
  Counts tare;
  Real gain;
  Counts dead_zone;
  Counts good; /* 1; 0 where the sensel is masked, 2 where the sensor has none */
#ifndef PF_WHOLE
  Wires wires;
#endif
} Correction;

/* Classifies a raw reading as missing or saturated, before calibration. */
PF_INLINE Sensel validate_reading(Counts raw, Counts good, Stages stages) {
  Sensel sensel = raw_sensel(raw);
#ifdef PF_RANGE
  if (PF_NAMED(reject_out_of_range)) sensel = reject_out_of_range(sensel, PF_VALUE(Real, largest));
#endif
#ifdef PF_MASK
  if (PF_NAMED(mask)) sensel = apply_mask(sensel, good);
#endif
#ifdef PF_SATURATION
  if (PF_NAMED(saturation)) sensel = mark_saturated(sensel, PF_VALUE(Counts, full_scale));
#endif
  return sensel;
}

#ifdef PF_CURVE
PF_INLINE CurvePolynomial curve_of(Stages stages) { return PF_NUMBER(curve_polynomial); }
#endif

/* Applies the stages before the tare. */
PF_INLINE Sensel untared_sensel(Counts raw, Correction at, Stages stages) {
  Sensel sensel = validate_reading(raw, at.good, stages);
#ifdef PF_WIRES
  if (PF_WIRES_ACT(false)) sensel = remove_crosstalk(sensel, at.wires);
#endif
  return sensel;
}

/* Applies the stages before the response. */
PF_INLINE Sensel gained_sensel(Counts raw, Correction at, Stages stages) {
  Sensel sensel = untared_sensel(raw, at, stages);
#ifdef PF_TARE
  if (PF_NAMED(tare)) sensel = subtract_tare(sensel, at.tare);
#endif
#ifdef PF_WIRES
  if (PF_WIRES_ACT(true)) sensel = remove_crosstalk(sensel, at.wires);
#endif
#ifdef PF_GAIN
  if (PF_NAMED(gain)) sensel = apply_gain(sensel, at.gain);
#endif
  return sensel;
}

/* Applies the stages of a sensel before its neighbours count: a valid reading is V. */
PF_INLINE Sensel linear_sensel(Counts raw, Correction at, Stages stages) {
  Sensel sensel = gained_sensel(raw, at, stages);
#ifdef PF_POWER_LAW
  if (PF_NAMED(power_law)) {
    sensel = apply_power_law(sensel, PF_VALUE(Real, exponent), PF_VALUE(Real, reference),
                             PF_VALUE(Real, largest));
  }
#endif
#ifdef PF_CURVE
  if (PF_NAMED(curve)) sensel.reading = curve_load(sensel.reading, curve_of(stages));
#endif
  return sensel;
}

#ifdef PF_LEAK
PF_INLINE LeakTaps leak_taps(Stages stages) {
  const LeakTaps taps = {PF_VALUE(Real, leak_self),   PF_VALUE(Real, leak_inside),
                         PF_VALUE(Real, leak_across), PF_VALUE(Real, leak_both_inside),
                         PF_VALUE(Real, leak_mixed),  PF_VALUE(Real, leak_both_across)};
  return taps;
}
#endif

/* Decides whether a sensel with the reading V is usable, and applies the stages after that. */
PF_INLINE Sensel active_sensel(Sensel sensel, Correction at, Stages stages) {
  sensel = classify(sensel, PF_VALUE(Counts, threshold));
#ifdef PF_DEAD_ZONE
  if (PF_NAMED(dead_zone)) sensel = fill_dead_zone(sensel, at.dead_zone);
#endif
  return sensel;
}

/* Applies the stages of a sensel that need neither its neighbours nor earlier frames. */
PF_INLINE Sensel correct_sensel(Counts raw, Correction at, Stages stages) {
  return active_sensel(linear_sensel(raw, at, stages), at, stages);
}

#ifdef PF_UNCERTAINTY
/* Noise of a sensel after correction, counts. */
PF_INLINE Real corrected_noise(Real noise, Counts raw, Correction at, Stages stages) {
#ifdef PF_WIRES
  if (PF_NAMED(wires)) noise = noise * wire_gain(PF_AFTER_TARE ? raw - at.tare : raw, at.wires);
#endif
#ifdef PF_GAIN
  if (PF_NAMED(gain)) noise = noise * at.gain;
#endif
#ifdef PF_POWER_LAW
  if (PF_NAMED(power_law)) {
    noise = noise * power_law_slope(gained_sensel(raw, at, stages).reading,
                                    PF_VALUE(Real, exponent), PF_VALUE(Real, reference));
  }
#endif
#ifdef PF_CURVE
  if (PF_NAMED(curve)) {
    noise = noise * curve_slope(gained_sensel(raw, at, stages).reading, curve_of(stages));
  }
#endif
  return noise;
}
#endif

#ifdef PF_RESIDUAL
#ifdef PF_UNCERTAINTY
/* Deviations with the residual as if it were common to the sensels of a pillar (E9). */
PF_INLINE Force with_common_residual(Force deviations, Force force, Stages stages) {
  const Real relative = PF_VALUE(Real, residual_relative);
  deviations.shear_x = plain_length_2(deviations.shear_x, relative * force.shear_x);
  deviations.shear_y = plain_length_2(deviations.shear_y, relative * force.shear_y);
  deviations.normal = plain_length_2(deviations.normal, relative * force.normal);
  const Real offset = sqrt(PF_VALUE(Real, residual_variance)) * PF_VALUE(Real, normal_scale);
  deviations.normal = plain_length_2(deviations.normal, offset + offset);
  return deviations;
}
#endif

/* Noise of a sensel with the relative part of what calibration leaves, counts (E9). */
PF_INLINE Real with_residual(Real noise, Sensel sensel, Stages stages) {
  const Real relative = PF_VALUE(Real, residual_relative) * sensel.reading;
  return sqrt(noise * noise + relative * relative);
}
#endif

#ifdef PF_SENSELS
/* Results of a sensel that is an element of its own. */
typedef struct {
  Real normal;
  Bits status;
#ifdef PF_UNCERTAINTY
  Real deviation;
#endif
} SenselSolution;

/* Solves a corrected sensel without a pillar; `noise` is its noise after correction, counts. */
PF_INLINE SenselSolution solve_sensel(Sensel sensel, Real noise, Stages stages) {
  const Real newtons_per_count = PF_VALUE(Real, normal_scale);
  SenselSolution solution;
  solution.normal = sensel_force(sensel, newtons_per_count);
  solution.status = sensel_status(sensel);
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
#ifdef PF_RESIDUAL
    if (PF_NAMED(residual)) {
      noise = with_residual(noise, sensel, stages);
      noise = sqrt(noise * noise + PF_VALUE(Real, residual_variance));
    }
#endif
    solution.deviation = sensel_deviation(sensel, noise, newtons_per_count);
  }
#endif
  return solution;
}
#endif

typedef struct {
  Force force;
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  Direction direction;
#endif
  Bits status;
#ifdef PF_UNCERTAINTY
  Force deviations;
  DirectionInterval interval;
#endif
} Solution;

PF_INLINE Force estimate_force(Pillar pillar, Diagonals diagonals, ParitySum sum, ForceScale scale,
                               Stages stages) {
#ifdef PF_PAPER
  if (PF_NAMED(paper_solve)) return paper_force(pillar, diagonals, sum, scale);
#endif
  return direct_force(diagonals, sum, scale);
}

PF_INLINE Bits status_of(Pillar pillar, Diagonals diagonals, ParitySum sum, Stages stages) {
  Counts margin = PF_VALUE(Counts, margin);
#ifdef PF_RESIDUAL
  if (PF_NAMED(residual)) {
    margin = margin + PF_VALUE(Real, relative_margin) * largest_reading(pillar);
  }
#endif
  Bits status = direct_status(pillar, diagonals, sum, margin);
#ifdef PF_PARITY_TEST
  if (PF_NAMED(parity_test)) {
    const Mask contradictory = fails_parity(pillar, sum, PF_VALUE(Counts, parity_tolerance));
    status = status | (bits_of(contradictory) & PF_BITS(PF_STATUS_INCONSISTENT));
  }
#endif
  return status;
}

#ifdef PF_SHEAR_COEFFICIENT
/* Divides the shear of a pillar with c = 1 by the coefficients (E2). */
PF_INLINE Force per_coefficient(Force force, Stages stages) {
  force.shear_x = force.shear_x * PF_VALUE(Real, per_coefficient_x);
  force.shear_y = force.shear_y * PF_VALUE(Real, per_coefficient_y);
  return force;
}
#endif

#ifdef PF_UNCERTAINTY
PF_INLINE ShearWeights shear_weights(Stages stages) {
  ShearWeights weights = {PF_REAL(1.0), PF_REAL(1.0), true};
#ifdef PF_SHEAR_COEFFICIENT
  if (PF_NAMED(shear_coefficient)) {
    weights.are_one = false;
    weights.x = PF_VALUE(Real, per_coefficient_x);
    weights.y = PF_VALUE(Real, per_coefficient_y);
  }
#endif
  return weights;
}
#endif

#ifdef PF_UNCERTAINTY
/* With finite deviations and bounds of the magnitude, also where their formulas overflow. */
PF_INLINE Solution bounded_solution(Solution solution) {
  solution.deviations.shear_x = bounded_n(solution.deviations.shear_x);
  solution.deviations.shear_y = bounded_n(solution.deviations.shear_y);
  solution.deviations.normal = bounded_n(solution.deviations.normal);
  solution.interval.magnitude_low = bounded_n(solution.interval.magnitude_low);
  solution.interval.magnitude_high = bounded_n(solution.interval.magnitude_high);
  return solution;
}
#endif

/* Solves a pillar from corrected sensels; `noise` is their noise after correction. */
PF_INLINE Solution solve_pillar(Pillar pillar, Noise noise, Stages stages) {
  const ForceScale scale = {PF_VALUE(Real, shear_scale), PF_VALUE(Real, normal_scale)};
  const Diagonals diagonals = pillar_diagonals(pillar);
  const ParitySum sum = parity_sum(diagonals, PF_VALUE(Fraction, segment_point));
  Solution solution;
  solution.force = estimate_force(pillar, diagonals, sum, scale, stages);
#ifdef PF_SHEAR_COEFFICIENT
  if (PF_NAMED(shear_coefficient)) solution.force = per_coefficient(solution.force, stages);
#endif
  solution.status = status_of(pillar, diagonals, sum, stages);
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  if (PF_NAMED(angles) || PF_NAMED(uncertainty)) {
    solution.direction = direction_of(solution.force);
  }
#endif
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
#ifdef PF_RESIDUAL
    if (PF_NAMED(residual)) {
      noise.n1 = with_residual(noise.n1, pillar.s1, stages);
      noise.n2 = with_residual(noise.n2, pillar.s2, stages);
      noise.n3 = with_residual(noise.n3, pillar.s3, stages);
      noise.n4 = with_residual(noise.n4, pillar.s4, stages);
    }
#endif
    solution.deviations =
        force_deviations(pillar, diagonals, sum, noise, PF_VALUE(Real, segment_point), scale);
    solution.interval = direction_interval(pillar, diagonals, sum, solution.direction, scale,
                                           shear_weights(stages));
    if (any_lane(any_saturated(pillar))) {
      const Open open = open_components(pillar, diagonals, sum);
      solution.deviations = open_deviations(solution.deviations, open, scale);
      solution.interval = open_interval(solution.interval, open);
    }
#ifdef PF_SHEAR_COEFFICIENT
    if (PF_NAMED(shear_coefficient)) {
      solution.deviations = per_coefficient(solution.deviations, stages);
    }
#endif
#ifdef PF_RESIDUAL
    if (PF_NAMED(residual)) {
      solution.deviations = with_common_residual(solution.deviations, solution.force, stages);
    }
#endif
    solution = bounded_solution(solution);
  }
#endif
  return solution;
}
