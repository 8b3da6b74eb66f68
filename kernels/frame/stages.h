/* The stages of the solve, in their one order, for the device and, as C++, for the host, which
 * lists them in host/solve/stages.cpp.
 *
 * A program defines the macro of each stage that its plan names; other stages are not compiled. C++
 * compiles all of them and tests PF_NAMED at run time.
 *
 * Where a new stage goes:
 * - Correction of one sensel: in correct_sensel, its effect on noise in corrected_noise. A
 *   parameter per sensel is a calibration plane and a member of Correction.
 * - Quantity of one pillar: in solve_pillar. Its results are lines of result_planes.h.
 * - Stage with neighbours: an entry point of its own, since a work-item of solve_frame.cl reads
 *   only the sensels of its block. It runs before solve_frame.cl, as crosstalk between sensels
 *   would, or after it, as follow_baseline.cl does.
 * - Stage with state: a plane that a frame reads like the tare and that an entry point after
 *   solve_frame.cl updates for the next frame. Frames then wait for each other on the device.
 * The host's table gives the kind of each stage, and whether idle blocks may be skipped: whether
 * activation_thresholds() and threshold_of_sensel() include it. */

#ifdef __cplusplus
#define PF_NAMED(stage) stages.stage
#define PF_LARGEST_READING stages.largest
#define PF_MASK
#define PF_FULL_SCALE stages.full_scale
#define PF_TARE
#define PF_GAIN
#define PF_POWER_EXPONENT stages.exponent
#define PF_POWER_REFERENCE stages.reference
#define PF_POWER_LARGEST stages.largest
#define PF_THRESHOLD stages.threshold
#define PF_DEAD_ZONE
#define PF_SHEAR_SCALE stages.scale.shear
#define PF_NORMAL_SCALE stages.scale.normal
#define PF_SEGMENT_POINT stages.segment_point
#define PF_PAPER
#define PF_MARGIN stages.margin
#define PF_PARITY_TOLERANCE stages.parity_tolerance
#define PF_ANGLES
#define PF_UNCERTAINTY

/* The stages that a plan names, and their constants. */
typedef struct {
  bool range;
  bool mask;
  bool saturation;
  bool tare;
  bool gain;
  bool power_law;
  bool dead_zone;
  bool paper;
  bool parity_test;
  bool angles;
  bool uncertainty;
  Real largest; /* counts, as those that follow */
  Real full_scale;
  Real exponent;
  Real reference;
  Real threshold;
  Real segment_point;
  Real margin;
  Real parity_tolerance;
  ForceScale scale;
} Stages;
#else
#define PF_NAMED(stage) 1
typedef int Stages; /* A program has macros instead. */
#endif

/* Calibration of a sensel; members of stages that are not named are not read. */
typedef struct {
  Counts tare;
  Real gain;
  Counts dead_zone;
  Counts good; /* 1; 0 where the sensel is masked, 2 where the sensor has none */
} Correction;

/* Classifies a raw reading as missing or saturated, before calibration. */
PF_INLINE Sensel validate_reading(Counts raw, Counts good, Stages stages) {
  Sensel sensel = raw_sensel(raw);
#ifdef PF_LARGEST_READING
  if (PF_NAMED(range)) sensel = reject_out_of_range(sensel, PF_CONSTANT(Real, PF_LARGEST_READING));
#endif
#ifdef PF_MASK
  if (PF_NAMED(mask)) sensel = apply_mask(sensel, good);
#endif
#ifdef PF_FULL_SCALE
  if (PF_NAMED(saturation)) sensel = mark_saturated(sensel, PF_CONSTANT(Counts, PF_FULL_SCALE));
#endif
  return sensel;
}

/* Applies the stages of a sensel to a raw reading. */
PF_INLINE Sensel correct_sensel(Counts raw, Correction at, Stages stages) {
  Sensel sensel = validate_reading(raw, at.good, stages);
#ifdef PF_TARE
  if (PF_NAMED(tare)) sensel = subtract_tare(sensel, at.tare);
#endif
#ifdef PF_GAIN
  if (PF_NAMED(gain)) sensel = apply_gain(sensel, at.gain);
#endif
#ifdef PF_POWER_EXPONENT
  if (PF_NAMED(power_law)) {
    sensel =
        apply_power_law(sensel, PF_CONSTANT(Real, PF_POWER_EXPONENT),
                        PF_CONSTANT(Real, PF_POWER_REFERENCE), PF_CONSTANT(Real, PF_POWER_LARGEST));
  }
#endif
  sensel = classify(sensel, PF_CONSTANT(Counts, PF_THRESHOLD));
#ifdef PF_DEAD_ZONE
  if (PF_NAMED(dead_zone)) sensel = fill_dead_zone(sensel, at.dead_zone);
#endif
  return sensel;
}

#ifdef PF_UNCERTAINTY
/* Noise of a sensel after correction, counts. */
PF_INLINE Real corrected_noise(Real noise, Counts raw, Correction at, Stages stages) {
#ifdef PF_GAIN
  if (PF_NAMED(gain)) noise = noise * at.gain;
#endif
#ifdef PF_POWER_EXPONENT
  if (PF_NAMED(power_law)) {
    Real reading = raw;
#ifdef PF_TARE
    if (PF_NAMED(tare)) reading = reading - at.tare;
#endif
#ifdef PF_GAIN
    if (PF_NAMED(gain)) reading = reading * at.gain;
#endif
    noise = noise * power_law_slope(reading, PF_CONSTANT(Real, PF_POWER_EXPONENT),
                                    PF_CONSTANT(Real, PF_POWER_REFERENCE));
  }
#endif
  return noise;
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
  if (PF_NAMED(paper)) return paper_force(pillar, diagonals, sum, scale);
#endif
  return direct_force(diagonals, sum, scale);
}

PF_INLINE Bits status_of(Pillar pillar, Diagonals diagonals, ParitySum sum, Stages stages) {
  Bits status = direct_status(pillar, diagonals, sum, PF_CONSTANT(Counts, PF_MARGIN));
#ifdef PF_PARITY_TOLERANCE
  if (PF_NAMED(parity_test)) {
    const Mask contradictory = fails_parity(pillar, sum, PF_CONSTANT(Counts, PF_PARITY_TOLERANCE));
    status = status | (bits_of(contradictory) & PF_BITS(PF_STATUS_INCONSISTENT));
  }
#endif
  return status;
}

/* Solves a pillar from corrected sensels; `noise` is their noise after correction. */
PF_INLINE Solution solve_pillar(Pillar pillar, Noise noise, Stages stages) {
  const ForceScale scale = {PF_CONSTANT(Real, PF_SHEAR_SCALE), PF_CONSTANT(Real, PF_NORMAL_SCALE)};
  const Diagonals diagonals = pillar_diagonals(pillar);
  const ParitySum sum = parity_sum(diagonals, PF_CONSTANT(Fraction, PF_SEGMENT_POINT));
  Solution solution;
  solution.force = estimate_force(pillar, diagonals, sum, scale, stages);
  solution.status = status_of(pillar, diagonals, sum, stages);
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  if (PF_NAMED(angles) || PF_NAMED(uncertainty)) {
    solution.direction = direction_of(solution.force);
  }
#endif
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    solution.deviations =
        force_deviations(pillar, diagonals, sum, noise, PF_CONSTANT(Real, PF_SEGMENT_POINT), scale);
    solution.interval = direction_interval(pillar, diagonals, sum, solution.direction, scale);
  }
#endif
  return solution;
}
