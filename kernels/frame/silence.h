/* Blocks that need no solving: where all readings are below the level that wakes their sensel,
 * forces and status do not depend on them, so a block that was silent when its place in the results
 * was last written has them there already (docs/performance_decisions.md). Stage PF_SKIP_SILENT.
 *
 * The levels are a plane of readings where sensels differ (PF_WAKE_PLANE), else PF_WAKE. A masked
 * sensel never wakes; a reading at the end of its type's range, NaN and absurd ones always do. */

/* The levels of a frame's sensels, of use where PF_WAKE_PLANE tells their place. */
PF_FUNCTION global const PF_SENSEL* wake_levels(Calibration calibration) {
#ifdef PF_WAKE_PLANE
  return PF_PLANE_OF(calibration, PF_SENSEL, PF_WAKE_PLANE);
#else
  return 0;
#endif
}

#ifdef PF_SKIP_SILENT

#ifdef PF_BASELINE
/* The level of sensels with these tares. */
PF_FUNCTION Real level_of(Real tare, Correction at) {
  Real gain = (Real)(1.0f);
#ifdef PF_GAIN
  gain = at.gain;
#endif
  const Real lowest = (Real)(PF_WAKE_LOWEST);
  const Real highest = (Real)(PF_WAKE_HIGHEST);
  const Real level =
      wake_level(tare, gain, (Real)(PF_WAKE_THRESHOLD), (Real)(PF_WAKE_STEP), lowest);
  const Real bounded = level < lowest ? lowest : (level < highest ? level : highest);
#ifdef PF_MASK
  return at.good == (Real)(0.0f) ? (Real)(PF_WAKE_NEVER) : bounded;
#else
  return bounded;
#endif
}
#endif

#ifdef PF_LARGEST_READING
#define PF_IS_AWAKE(reading, level) \
  (!((reading) < (level)) || (reading) < (PF_SENSEL)(-(PF_LARGEST_READING)))
#else
#define PF_IS_AWAKE(reading, level) ((reading) >= (level))
#endif

/* Whether no sensel under PF_LANES pillars is awake. `wake` is the level of the first one. */
PF_FUNCTION bool is_silent(global const PF_SENSEL* raw, size_t row_stride,
                           global const PF_SENSEL* wake, size_t wake_stride) {
#if PF_LANES == 1
#define PF_READING(place, i) (place)[i]
#else
#define PF_READING(place, i) PF_LOAD_WHOLE(PF_SENSEL, (place) + (i)*PF_LANES)
#endif
#ifdef PF_WAKE_PLANE
#define PF_LEVEL(row, i) PF_READING(wake + row * wake_stride, i)
#else
#define PF_LEVEL(row, i) (PF_SENSEL)(PF_WAKE)
#endif
#define PF_AWAKE(row, i) PF_IS_AWAKE(PF_READING(raw + row * row_stride, i), PF_LEVEL(row, i))
#if PF_LANES == 1
  return !(PF_AWAKE(0, 0) || PF_AWAKE(0, 1) || PF_AWAKE(1, 0) || PF_AWAKE(1, 1));
#elif defined(PF_WAKE) && !defined(PF_LARGEST_READING)
  /* One level for all, and no NaN: only the highest is to be asked. */
  global const PF_SENSEL* const below_raw = raw + row_stride;
  const PF_LANE_TYPE(PF_SENSEL) above = max(PF_READING(raw, 0), PF_READING(raw, 1));
  const PF_LANE_TYPE(PF_SENSEL) below = max(PF_READING(below_raw, 0), PF_READING(below_raw, 1));
  return !any_bits(PF_JOIN(convert_char, PF_LANES)(
      PF_IS_AWAKE(max(above, below), (PF_LANE_TYPE(PF_SENSEL))(PF_LEVEL(0, 0)))));
#else
  return !any_bits(PF_JOIN(
      convert_char, PF_LANES)(PF_AWAKE(0, 0) | PF_AWAKE(0, 1) | PF_AWAKE(1, 0) | PF_AWAKE(1, 1)));
#endif
}

#endif
