/* Corrects and classifies one sensel. Each function is a stage; frame/stages.h calls those that a
 * plan names, in order (docs/derivations/direct_solve.md, section 1). */

/* A reading in counts and its relation to the model's V. After `classify` at most one of
 * usable, saturated and missing is set; a sensel with none is inactive. */
typedef struct {
  Counts reading;
  Mask usable;    /* V is the reading, which is above the threshold */
  Mask saturated; /* V is at least the reading, which is above the threshold */
  Mask missing;   /* V is unconstrained: dead, absent, masked, or not a number; reads zero */
  Mask absent;    /* missing because the sensor has no sensel there, which is not a fault */
} Sensel;

/* A valid sensel with the reading `raw`. */
PF_INLINE Sensel raw_sensel(Counts raw) {
  Sensel sensel;
  sensel.reading = raw;
  sensel.usable = mask_of(PF_BITS(0));
  sensel.missing = mask_of(PF_BITS(0));
  sensel.saturated = mask_of(PF_BITS(0));
  sensel.absent = mask_of(PF_BITS(0));
  return sensel;
}

#ifndef PF_WHOLE
/* NaN, infinity and readings beyond `largest` count as missing; for float32 sensels. */
PF_INLINE Sensel reject_out_of_range(Sensel sensel, Real largest) {
  sensel.missing = sensel.missing || !(fabs(sensel.reading) <= largest);
  return sensel;
}
#endif

/* `good` is 1, 0 where the sensel is masked, 2 where the sensor has none. */
PF_INLINE Sensel apply_mask(Sensel sensel, Counts good) {
  sensel.missing = sensel.missing || !(good == PF_COUNTS(1));
  sensel.absent = good == PF_COUNTS(2);
  return sensel;
}

/* A raw reading of `full_scale` counts or more is saturated. */
PF_INLINE Sensel mark_saturated(Sensel sensel, Counts full_scale) {
  sensel.saturated = (sensel.reading >= full_scale) && !sensel.missing;
  return sensel;
}

PF_INLINE Sensel subtract_tare(Sensel sensel, Counts tare) {
  sensel.reading = sensel.reading - tare;
  return sensel;
}

#ifndef PF_WHOLE
PF_INLINE Sensel apply_gain(Sensel sensel, Real gain) {
  sensel.reading = sensel.reading * gain;
  return sensel;
}

/* Linearises a reading r above zero by the power law V = reference (r / reference)^exponent,
 * `largest` at most. */
PF_INLINE Sensel apply_power_law(Sensel sensel, Real exponent, Real reference, Real largest) {
  const Real straight = reference * power_of(fabs(sensel.reading) / reference, exponent);
  const Real bounded = straight < largest ? straight : largest;
  sensel.reading = sensel.reading > PF_REAL(0.0) ? bounded : sensel.reading;
  return sensel;
}

/* dV / dr of the power law, the factor on small noise; at most 1e6, so that its square is finite.
 */
PF_INLINE Real power_law_slope(Real reading, Real exponent, Real reference) {
  const Real most = PF_REAL(1e6);
  const Real slope = exponent * power_of(fabs(reading) / reference, exponent - PF_REAL(1.0));
  return slope < most ? slope : most;
}

/* A drift of tares, counts: a plane over the columns and rows of pillars. */
typedef struct {
  float first; /* of the pillar (0, 0) */
  float per_col;
  float per_row;
} Drift;

PF_INLINE Real drift_at(Drift drift, Real col, Real row) {
  return PF_CONSTANT(Real, drift.first) +
         (col * PF_CONSTANT(Real, drift.per_col) + row * PF_CONSTANT(Real, drift.per_row));
}

/* Updates a tare: that of a sensel that follows, with a valid reading, by `rate` times the
 * difference between the raw reading and the tare, another one by the drift that untouched sensels
 * share. */
PF_INLINE Real follow_tare(Real tare, Sensel raw, Mask may_follow, Real rate, Real drift) {
  const Mask follows = may_follow && !(raw.missing || raw.saturated);
  return tare + (follows ? rate * (raw.reading - tare) : drift);
}
#endif

#ifndef PF_WHOLE
/* A change of the skin's curvature, 1/mm. */
typedef struct {
  float x;
  float y;
  float xy;
} Curvature;

/* The tare after a change of curvature; the patterns are in counts mm. */
PF_INLINE Real bent_tare(Real tare, Real x, Real y, Real xy, Curvature change) {
  return tare + (x * PF_CONSTANT(Real, change.x) + y * PF_CONSTANT(Real, change.y) +
                 xy * PF_CONSTANT(Real, change.xy));
}
#endif

/* Classifies a reading: above `threshold` counts (zero or more) the sensel is usable or saturated.
 * Otherwise it is inactive and reads the threshold, the upper bound of V, or missing and reads
 * zero. A saturated sensel whose corrected reading is not above the threshold is missing. */
PF_INLINE Sensel classify(Sensel sensel, Counts threshold) {
  const Mask is_active = (sensel.reading > threshold) && !sensel.missing;
  const Mask is_uninformative = sensel.missing || (sensel.saturated && !is_active);
  sensel.missing = is_uninformative;
  sensel.usable = is_active && !sensel.saturated;
  sensel.saturated = is_active && sensel.saturated;
  sensel.reading = is_active ? sensel.reading : (is_uninformative ? PF_COUNTS(0) : threshold);
  return sensel;
}

#ifndef PF_WHOLE
/* Activation threshold of a sensel, raw counts: readings below it, in steps of `step` (1: whole
 * readings, 0: any), are inactive after tare and gain. It is the highest such threshold but for
 * rounding, computed with the arithmetic of the stages, which is monotonic in the reading; `lowest`
 * where rounding leaves none. */
PF_INLINE Real activation_threshold(Real tare, Real gain, Real threshold, Real step, Real lowest) {
  const Real largest_inactive = floor(tare + threshold / gain);
  const Real below = largest_inactive - PF_REAL(1.0);
  const Mask is_idle = (largest_inactive - tare) * gain <= threshold;
  const Mask is_idle_below = (below - tare) * gain <= threshold;
  return is_idle ? largest_inactive + step : (is_idle_below ? below + step : lowest);
}
#endif

/* Adds the dead zone, counts, to a reading, or to the upper bound of an inactive sensel. */
PF_INLINE Sensel fill_dead_zone(Sensel sensel, Counts dead_zone) {
  sensel.reading = sensel.missing ? sensel.reading : sensel.reading + dead_zone;
  return sensel;
}

/* True if V is at most the reading: the threshold plus the dead zone. */
PF_INLINE Mask is_inactive(Sensel sensel) {
  return !(sensel.usable || sensel.saturated || sensel.missing);
}
