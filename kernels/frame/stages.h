/* A frame's sensels through the stages that the plan asks for; shared by the entry points. The
 * macros are listed in solve_frame.cl. */

/* A raw reading, and what is wrong with it before any calibration. */
PF_INLINE Sensel judge_reading(Counts raw, Counts good) {
  Sensel sensel = raw_sensel(raw);
#ifdef PF_LARGEST_READING
  sensel = reject_absurd(sensel, (Real)(PF_LARGEST_READING));
#endif
#ifdef PF_MASK
  sensel = apply_mask(sensel, good);
#endif
#ifdef PF_FULL_SCALE
  sensel = mark_saturated(sensel, (Counts)(PF_FULL_SCALE));
#endif
  return sensel;
}

/* A raw reading through the stages of the plan. */
PF_INLINE Sensel prepare_sensel(Counts raw, Counts tare, Real gain, Counts dead_zone, Counts good) {
  Sensel sensel = judge_reading(raw, good);
#ifdef PF_TARE
  sensel = subtract_tare(sensel, tare);
#endif
#ifdef PF_GAIN
  sensel = apply_gain(sensel, gain);
#endif
#ifdef PF_POWER_EXPONENT
  sensel = apply_power_law(sensel, (Real)(PF_POWER_EXPONENT), (Real)(PF_POWER_REFERENCE),
                           (Real)(PF_POWER_LARGEST));
#endif
  sensel = classify(sensel, (Counts)(PF_THRESHOLD));
#ifdef PF_DEAD_ZONE
  sensel = fill_dead_zone(sensel, dead_zone);
#endif
  return sensel;
}

/* The calibration planes [rows, stride]; null where the plan has none. */
typedef struct {
  global const float* tare;
  global const float* gain;
  global const float* dead_zone;
  global const uchar* mask;
  global const float* noise;
  size_t stride;
} Planes;

typedef struct {
  Sensel left;
  Sensel right;
} SenselPair;

/* The sensels of one row under PF_LANES pillars. `offset` is the first one's place in the planes.
 */
PF_INLINE SenselPair read_sensels(global const PF_SENSEL* raw, Planes planes, size_t offset) {
  const CountsPair readings = load_readings(raw);
  CountsPair tares = {(Counts)(0), (Counts)(0)};
  CountsPair dead_zones = tares;
  CountsPair good = tares;
  RealPair gains = {(Real)(0.0f), (Real)(0.0f)};
#ifdef PF_TARE
  tares = load_plane(planes.tare + offset);
#endif
#ifdef PF_GAIN
  gains = load_plane(planes.gain + offset);
#endif
#ifdef PF_DEAD_ZONE
  dead_zones = load_plane(planes.dead_zone + offset);
#endif
#ifdef PF_MASK
  good = load_mask(planes.mask + offset);
#endif
  SenselPair pair;
  pair.left = prepare_sensel(readings.left, tares.left, gains.left, dead_zones.left, good.left);
  pair.right =
      prepare_sensel(readings.right, tares.right, gains.right, dead_zones.right, good.right);
  return pair;
}

#ifdef PF_UNCERTAINTY
/* The noise of those sensels as the corrections leave it, counts. */
PF_INLINE RealPair read_noise(global const PF_SENSEL* raw, Planes planes, size_t offset) {
  RealPair noise = {(Real)(PF_UNCERTAINTY), (Real)(PF_UNCERTAINTY)};
#ifdef PF_NOISE
  noise = load_plane(planes.noise + offset);
#endif
#ifdef PF_GAIN
  const RealPair gains = load_plane(planes.gain + offset);
  noise.left = noise.left * gains.left;
  noise.right = noise.right * gains.right;
#endif
#ifdef PF_POWER_EXPONENT
  RealPair readings = load_readings(raw);
#ifdef PF_TARE
  const RealPair tares = load_plane(planes.tare + offset);
  readings.left = readings.left - tares.left;
  readings.right = readings.right - tares.right;
#endif
#ifdef PF_GAIN
  readings.left = readings.left * gains.left;
  readings.right = readings.right * gains.right;
#endif
  const Real exponent = (Real)(PF_POWER_EXPONENT);
  const Real reference = (Real)(PF_POWER_REFERENCE);
  noise.left = noise.left * power_law_slope(readings.left, exponent, reference);
  noise.right = noise.right * power_law_slope(readings.right, exponent, reference);
#endif
  return noise;
}
#endif

/* Prefetches what calibrates both rows of sensels under a block. Processors follow a row by
 * themselves, but lose it at the end of a page; a row ahead they are late for none. */
PF_INLINE void prefetch_planes(Planes planes, size_t offset) {
  for (uint row = 0; row < 2; ++row) {
#ifdef PF_TARE
    PF_PREFETCH(planes.tare + offset + row * planes.stride);
#endif
#ifdef PF_GAIN
    PF_PREFETCH(planes.gain + offset + row * planes.stride);
#endif
#ifdef PF_DEAD_ZONE
    PF_PREFETCH(planes.dead_zone + offset + row * planes.stride);
#endif
#ifdef PF_MASK
    PF_PREFETCH(planes.mask + offset + row * planes.stride);
#endif
#ifdef PF_NOISE
    PF_PREFETCH(planes.noise + offset + row * planes.stride);
#endif
  }
}

/* Pillar rows. */
typedef struct {
  uint first;
  uint end;
} Band;

/* The rows of this work-item: its band among get_global_size(1) of like height. */
PF_INLINE Band band_of_rows(uint rows) {
  const ulong bands = get_global_size(1);
  const ulong band = get_global_id(1);
  const Band result = {(uint)(band * rows / bands), (uint)((band + 1) * rows / bands)};
  return result;
}

/* Blocks of a row of pillars at most, wherever it begins. */
PF_INLINE uint blocks_of_row(uint cols) { return cols / PF_LANES + 2; }
