/* One sensel, from its raw reading to what the solve may believe of it. Each function is a stage;
 * an entry point calls those that its scene needs, in the order of this file
 * (docs/derivations/direct_solve.md, section 1). */

/* A reading in counts and what is known of it. Until `classify`, nothing is usable. */
typedef struct {
  Real reading;
  Mask usable;    /* above the threshold: a measurement of the model's V */
  Mask missing;   /* tells nothing: dead, absent, masked, or not a number */
  Mask saturated; /* tells only that V is at least the reading */
} Sensel;

/* A sensel that read `raw` and has nothing wrong with it. */
static inline Sensel raw_sensel(Real raw) {
  Sensel sensel;
  sensel.reading = raw;
  sensel.usable = raw < raw;
  sensel.missing = sensel.usable;
  sensel.saturated = sensel.usable;
  return sensel;
}

/* NaN, infinity and readings beyond `largest` count as missing; for float32 sensels. */
static inline Sensel reject_absurd(Sensel sensel, Real largest) {
  sensel.missing = sensel.missing | !(fabs(sensel.reading) <= largest);
  return sensel;
}

/* `good` is zero where the sensel is masked. */
static inline Sensel apply_mask(Sensel sensel, Real good) {
  sensel.missing = sensel.missing | (good == PF_REAL(0.0));
  return sensel;
}

/* A reading of `full_scale` counts or more is saturated; to be asked of the raw reading. */
static inline Sensel mark_saturated(Sensel sensel, Real full_scale) {
  sensel.saturated = (sensel.reading >= full_scale) & !sensel.missing;
  return sensel;
}

static inline Sensel subtract_tare(Sensel sensel, Real tare) {
  sensel.reading = sensel.reading - tare;
  return sensel;
}

static inline Sensel apply_gain(Sensel sensel, Real gain) {
  sensel.reading = sensel.reading * gain;
  return sensel;
}

/* Readings above `threshold` counts are usable; what is neither usable nor saturated reads zero,
 * and what is also not missing is lifted. */
static inline Sensel classify(Sensel sensel, Real threshold) {
  const Mask excluded = sensel.missing | sensel.saturated;
  sensel.usable = (sensel.reading > threshold) & !excluded;
  sensel.reading = (sensel.usable | sensel.saturated) ? sensel.reading : PF_REAL(0.0);
  return sensel;
}

/* Gives back to a sensel that answers the `dead_zone` counts it swallowed. */
static inline Sensel fill_dead_zone(Sensel sensel, Real dead_zone) {
  const Mask answers = sensel.usable | sensel.saturated;
  sensel.reading = answers ? sensel.reading + dead_zone : sensel.reading;
  return sensel;
}

/* Neither pressed nor unknown: the model's V is at most zero. */
static inline Mask is_lifted(Sensel sensel) {
  return !(sensel.usable | sensel.missing | sensel.saturated);
}
