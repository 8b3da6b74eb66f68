/* Skips idle blocks. Forces and status do not depend on readings below the activation threshold. If
 * the block was idle when this slot was last written, its results are still valid and it is skipped
 * (docs/performance_decisions.md). Stage PF_SKIP_IDLE.
 *
 * Activation thresholds are a plane of readings where sensels differ (PF_ACTIVATION_PLANE), else
 * one number. A masked sensel is never active; NaN and readings at or beyond the end of the
 * range always are. */

/* The plane of activation thresholds; null without PF_ACTIVATION_PLANE. */
PF_INLINE global const PF_SENSEL* activation_thresholds(Calibration calibration) {
#ifdef PF_ACTIVATION_PLANE
  return PF_PLANE_OF(calibration, PF_SENSEL, PF_ACTIVATION_PLANE);
#else
  return 0;
#endif
}

/* Idle flag of a block. Zero: active. Its lowest bit is set while the block is idle. With a leak
 * between pillars, whose correction writes the results, PF_NEWLY_IDLE is that of the first idle
 * frame. */
#define PF_IDLE 1
#ifdef PF_PILLAR_LEAK
#define PF_NEWLY_IDLE (PF_NAMED(pillar_leak) ? 3 : PF_IDLE)
#else
#define PF_NEWLY_IDLE PF_IDLE
#endif

/* Idle flags of eight blocks as one word, and that of eight idle blocks. */
typedef struct __attribute__((packed, may_alias)) {
  ulong value;
} EightFlags;
#define PF_EIGHT_IDLE (PF_IDLE * 0x0101010101010101ul)
PF_INLINE ulong eight_flags(global const uchar* flags) {
  return ((global const EightFlags*)flags)->value;
}

#ifdef PF_SKIP_IDLE

#if defined(PF_BASELINE) || defined(PF_BEND)
/* Activation threshold of sensels with these tares and corrections, raw counts. */
PF_INLINE Real threshold_of_sensel(Real tare, Correction at, Stages stages) {
  Real gain = PF_CONSTANT(Real, 1.0f);
#ifdef PF_GAIN
  if (PF_NAMED(gain)) gain = at.gain;
#endif
  const Real lowest = PF_VALUE(Real, activation_lowest);
  const Real highest = PF_VALUE(Real, activation_highest);
  const Real threshold = activation_threshold(tare, gain, PF_VALUE(Real, activation_cut),
                                              PF_VALUE(Real, activation_step), lowest);
  const Real bounded = threshold < lowest ? lowest : (threshold < highest ? threshold : highest);
#ifdef PF_MASK
  if (!PF_NAMED(mask)) return bounded;
  return at.good != PF_CONSTANT(Real, 1.0f) ? PF_VALUE(Real, activation_never) : bounded;
#else
  return bounded;
#endif
}
#endif

#ifdef PF_RANGE
#define PF_IS_ACTIVE(reading, threshold) \
  (!((reading) < (threshold)) || (reading) < (PF_SENSEL)(-PF_NUMBER(largest)))
#else
#define PF_IS_ACTIVE(reading, threshold) ((reading) >= (threshold))
#endif

/* True if no sensel under PF_LANES pillars is active. `activation` points to the first sensel's
 * threshold. */
PF_INLINE bool is_idle(global const PF_SENSEL* raw, size_t row_stride,
                       global const PF_SENSEL* activation, size_t activation_stride,
                       Stages stages) {
#ifdef PF_SCALAR
#define PF_READING(place, i) (place)[i]
#else
#define PF_READING(place, i) PF_LOAD_WHOLE(PF_SENSEL, (place) + (i)*PF_LANES)
#endif
#ifdef PF_ACTIVATION_PLANE
#define PF_THRESHOLD_AT(row, i) PF_READING(activation + row * activation_stride, i)
#else
#define PF_THRESHOLD_AT(row, i) (PF_SENSEL)(PF_NUMBER(activation))
#endif
#define PF_ACTIVE(row, i) \
  PF_IS_ACTIVE(PF_READING(raw + row * row_stride, i), PF_THRESHOLD_AT(row, i))
#ifdef PF_SCALAR
  return !(PF_ACTIVE(0, 0) || PF_ACTIVE(0, 1) || PF_ACTIVE(1, 0) || PF_ACTIVE(1, 1));
#elif !defined(PF_ACTIVATION_PLANE) && !defined(PF_RANGE)
  /* One threshold for all sensels, and no NaN: comparing the largest reading suffices. */
  global const PF_SENSEL* const below_raw = raw + row_stride;
  const PF_LANE_TYPE(PF_SENSEL) above = max(PF_READING(raw, 0), PF_READING(raw, 1));
  const PF_LANE_TYPE(PF_SENSEL) below = max(PF_READING(below_raw, 0), PF_READING(below_raw, 1));
  return !PF_ANY((PF_IS_ACTIVE(max(above, below),
                               PF_CONSTANT(PF_LANE_TYPE(PF_SENSEL), PF_THRESHOLD_AT(0, 0)))));
#else
  return !PF_ANY((PF_ACTIVE(0, 0) | PF_ACTIVE(0, 1) | PF_ACTIVE(1, 0) | PF_ACTIVE(1, 1)));
#endif
}

#endif

#if defined(PF_BASELINE) || defined(PF_BEND)
/* Stores the tares of one row of sensels, and the activation thresholds that follow from them; of
 * `lanes`. */
PF_INLINE void store_tares(RealPair tares, Calibration calibration, Place place, CorrectionPair at,
                           Lanes lanes) {
  const size_t offset = offset_of(calibration, place);
  store_pair(tares, (global float*)PF_PLANE_OF(calibration, float, PF_TARE_PLANE) + offset, lanes);
#ifdef PF_SKIP_IDLE
  const RealPair thresholds = {threshold_of_sensel(tares.left, at.left, calibration.stages),
                               threshold_of_sensel(tares.right, at.right, calibration.stages)};
  store_readings(thresholds, (global PF_SENSEL*)activation_thresholds(calibration) + offset, lanes);
#endif
}
#endif
