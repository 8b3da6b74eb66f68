/* Tells the rest that a touch leaves behind from a load (docs/derivations/sensor_effects.md, E13).
 */

/* The largest part of a touch that its release may leave, of a block of 2 x 2 sensels with those
 * around it, and of the block alone, where rests are less even. */
#define PF_LARGEST_REST PF_REAL(0.2)
#define PF_LARGEST_OWN_REST PF_REAL(0.35)
#define PF_RELEASED PF_REAL(0.5) /* of the release time: the rest was steady for so long */

/* The pace of a baseline: `rate`, fraction of reading - tare that is added to an untouched tare in
 * a turn, 0..1; `step`, time from turn to turn over the release time, 0: nothing is remembered;
 * `band`, counts above the tare that are no touch. */
typedef struct {
  float rate;
  float step;
  float band;
} BaselinePace;

/* Memory of a block of its touch, mean counts above the tares. */
typedef struct {
  Real peak; /* largest load; zero once the rest has gone */
  Real low;  /* smallest since the load was last large beside the peak */
  Real rest; /* time since it is that low, over the release time */
  Real now;
} Release;

/* The memory after a turn in which the block reads `now`; `peaks` and `loads` are sums over it and
 * the eight blocks around it. */
PF_INLINE Release release_after(Release before, Real now, Real peaks, Real loads,
                                BaselinePace pace) {
  const Real band = PF_CONSTANT(Real, pace.band);
  const Real step = PF_CONSTANT(Real, pace.step);
  const Mask inside = now <= before.low + band;
  const Mask begins = !inside && (before.low < band);
  Release after = before;
  after.now = now;
  after.peak = (begins || (now > before.peak)) ? now : before.peak;
  const Mask quiet = (loads <= PF_LARGEST_REST * peaks) || (loads <= PF_REAL(2.0) * band);
  const Mask loaded = (now > band) && (!quiet || (now > PF_LARGEST_OWN_REST * after.peak));
  const Real follows = inside ? before.low + step * (now - before.low) : before.low;
  const Real lowest = now < follows ? now : follows;
  after.low = loaded ? now : lowest;
  const Mask left = (before.peak > PF_REAL(2.0) * band) || (before.rest >= PF_REAL(1.0));
  const Real rest = before.rest < PF_REAL(1000.0) ? before.rest + step : before.rest;
  after.rest = (left && quiet && inside && !loaded) ? rest : PF_REAL(0.0);
  after.peak = after.rest >= PF_REAL(1.0) ? PF_REAL(0.0) : after.peak;
  return after;
}

PF_INLINE Mask is_released(Release release) { return release.rest >= PF_RELEASED; }

/* Fraction of reading - tare that is added to the tare of an untouched or released sensel: after a
 * release that of a mean over the last quarter of the time since. */
PF_INLINE Real rate_after(Release release, BaselinePace pace) {
  const Real turn = PF_CONSTANT(Real, pace.step);
  const Real slow = PF_CONSTANT(Real, pace.rate);
  const Real since = release.rest - PF_RELEASED;
  const Real fast = PF_REAL(4.0) * turn / (PF_REAL(8.0) * turn + since);
  return (is_released(release) && (fast > slow)) ? fast : slow;
}
