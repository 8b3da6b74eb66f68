/* One sensel, from its raw reading to what the solve may believe of it. Each function is a stage;
 * frame/stages.h calls those that a plan names, in its order
 * (docs/derivations/direct_solve.md, section 1). */

/* A reading in counts and what it tells of the model's V. After `classify` at most one mask is set;
 * a sensel with none is inactive. */
typedef struct {
  Counts reading;
  Mask usable;    /* V is the reading, which is above the threshold */
  Mask saturated; /* V is at least the reading, which is above the threshold */
  Mask missing;   /* tells nothing: dead, absent, masked, or not a number; reads zero */
} Sensel;

/* A sensel that read `raw` and has nothing wrong with it. */
static inline Sensel raw_sensel(Counts raw) {
  Sensel sensel;
  sensel.reading = raw;
  sensel.usable = mask_of(PF_BITS(0));
  sensel.missing = mask_of(PF_BITS(0));
  sensel.saturated = mask_of(PF_BITS(0));
  return sensel;
}

#ifndef PF_WHOLE
/* NaN, infinity and readings beyond `largest` count as missing; for float32 sensels. */
static inline Sensel reject_out_of_range(Sensel sensel, Real largest) {
  sensel.missing = sensel.missing || !(fabs(sensel.reading) <= largest);
  return sensel;
}
#endif

/* `good` is zero where the sensel is masked. */
static inline Sensel apply_mask(Sensel sensel, Counts good) {
  sensel.missing = sensel.missing || (good == PF_COUNTS(0));
  return sensel;
}

/* A reading of `full_scale` counts or more is saturated; to be asked of the raw reading. */
static inline Sensel mark_saturated(Sensel sensel, Counts full_scale) {
  sensel.saturated = (sensel.reading >= full_scale) && !sensel.missing;
  return sensel;
}

static inline Sensel subtract_tare(Sensel sensel, Counts tare) {
  sensel.reading = sensel.reading - tare;
  return sensel;
}

#ifndef PF_WHOLE
static inline Sensel apply_gain(Sensel sensel, Real gain) {
  sensel.reading = sensel.reading * gain;
  return sensel;
}

/* Straightens a sensel that does not answer in proportion: a reading r above zero stands for
 * V = reference (r / reference)^exponent, `largest` at most. */
static inline Sensel apply_power_law(Sensel sensel, Real exponent, Real reference, Real largest) {
  const Real straight = reference * pow(fabs(sensel.reading) / reference, exponent);
  const Real bounded = straight < largest ? straight : largest;
  sensel.reading = sensel.reading > PF_REAL(0.0) ? bounded : sensel.reading;
  return sensel;
}

/* dV / dr of that law, by which small noise grows; a million at most, so that its square is finite.
 */
static inline Real power_law_slope(Real reading, Real exponent, Real reference) {
  const Real most = PF_REAL(1e6);
  const Real slope = exponent * pow(fabs(reading) / reference, exponent - PF_REAL(1.0));
  return slope < most ? slope : most;
}

/* The tare of a sensel after one more frame: `rate` of its distance from the raw reading is taken
 * over, where nothing touches the sensel and the reading tells anything. */
static inline Real follow_tare(Real tare, Sensel raw, Mask untouched, Real rate) {
  const Real followed = tare + rate * (raw.reading - tare);
  return (untouched && !(raw.missing || raw.saturated)) ? followed : tare;
}
#endif

/* Splits the readings: above `threshold` counts (zero or more) a sensel is usable or saturated. All
 * others are inactive, and read the threshold, which is the most that their silence can hide; or
 * missing, and read zero. A saturated sensel that its calibration brings down to the threshold
 * tells nothing. */
static inline Sensel classify(Sensel sensel, Counts threshold) {
  const Mask answers = (sensel.reading > threshold) && !sensel.missing;
  const Mask is_uninformative = sensel.missing || (sensel.saturated && !answers);
  sensel.missing = is_uninformative;
  sensel.usable = answers && !sensel.saturated;
  sensel.saturated = answers && sensel.saturated;
  sensel.reading = answers ? sensel.reading : (is_uninformative ? PF_COUNTS(0) : threshold);
  return sensel;
}

#ifndef PF_WHOLE
/* A level such that every reading below it, in steps of `step` (1: whole readings, 0: any), is
 * silent after tare and gain: the highest but for rounding. It is found by the arithmetic of the
 * stages, which only rises with the reading. `lowest` where numbers are too large to tell. */
static inline Real activation_threshold(Real tare, Real gain, Real threshold, Real step,
                                        Real lowest) {
  const Real silent = floor(tare + threshold / gain);
  const Real below = silent - PF_REAL(1.0);
  const Mask is_idle = (silent - tare) * gain <= threshold;
  const Mask is_idle_below = (below - tare) * gain <= threshold;
  return is_idle ? silent + step : (is_idle_below ? below + step : lowest);
}
#endif

/* Gives back the `dead_zone` counts that a sensel swallows before it answers, and that the silence
 * of a inactive one can hide as well. */
static inline Sensel fill_dead_zone(Sensel sensel, Counts dead_zone) {
  sensel.reading = sensel.missing ? sensel.reading : sensel.reading + dead_zone;
  return sensel;
}

/* Silent and not missing: V is at most the reading, which is threshold and dead zone together. */
static inline Mask is_inactive(Sensel sensel) {
  return !(sensel.usable || sensel.saturated || sensel.missing);
}
