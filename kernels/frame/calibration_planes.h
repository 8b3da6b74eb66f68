/* Calibration planes in memory (layout.h). The host defines the index of each plane that a stage
 * reads: PF_TARE_PLANE and so on. */
#ifdef PF_NOISE
#define PF_HAS_NOISE_PLANE 1
#elif !defined(PF_HAS_NOISE_PLANE)
#define PF_HAS_NOISE_PLANE 0
#define PF_NOISE_PLANE 0
#endif

typedef struct {
  global const uchar* planes;
  size_t plane_bytes;
  size_t stride; /* sensels of a row */
  Stages stages;
  uint frame; /* number of the frame, from 1 on */
#ifdef PF_WIRES
  WireVectors wires;
#endif
} Calibration;

#define PF_PLANE_OF(calibration, type, plane) \
  ((global const type*)((calibration).planes + (plane) * (calibration).plane_bytes))

/* Corrections of the left and right sensels of PF_LANES pillars. */
typedef struct {
  Correction left;
  Correction right;
} CorrectionPair;

/* The first of the sensels of one row under PF_LANES pillars: its row and column. */
typedef struct {
  uint row;
  uint col;
} Place;

PF_INLINE size_t offset_of(Calibration calibration, Place place) {
  return place.row * calibration.stride + place.col;
}

/* Loads the corrections of one row of sensels under PF_LANES pillars. */
PF_INLINE CorrectionPair load_corrections(Calibration calibration, Place place) {
  Correction none;
  none.tare = PF_CONSTANT(Counts, 0);
  none.gain = PF_CONSTANT(Real, 0.0f);
  none.dead_zone = PF_CONSTANT(Counts, 0);
  none.good = PF_CONSTANT(Counts, 0);
#ifdef PF_WIRES
  none.wires.row = none.wires.own = none.wires.column = PF_CONSTANT(Real, 0.0f);
#endif
  CorrectionPair pair = {none, none};
#ifdef PF_WIRES
  if (PF_NAMED(wires)) {
    const WiresPair wires = load_wires(calibration.wires, place.row, place.col);
    pair.left.wires = wires.left;
    pair.right.wires = wires.right;
  }
#endif
#ifdef PF_TARE
  if (PF_NAMED(tare)) {
    const RealPair tares =
        load_plane(PF_PLANE_OF(calibration, float, PF_TARE_PLANE) + offset_of(calibration, place));
    pair.left.tare = tares.left;
    pair.right.tare = tares.right;
  }
#endif
#ifdef PF_GAIN
  if (PF_NAMED(gain)) {
    const RealPair gains =
        load_plane(PF_PLANE_OF(calibration, float, PF_GAIN_PLANE) + offset_of(calibration, place));
    pair.left.gain = gains.left;
    pair.right.gain = gains.right;
  }
#endif
#ifdef PF_DEAD_ZONE
  if (PF_NAMED(dead_zone)) {
    const RealPair zones = load_plane(PF_PLANE_OF(calibration, float, PF_DEAD_ZONE_PLANE) +
                                      offset_of(calibration, place));
    pair.left.dead_zone = zones.left;
    pair.right.dead_zone = zones.right;
  }
#endif
#ifdef PF_MASK
  if (PF_NAMED(mask)) {
    const RealPair good =
        load_mask(PF_PLANE_OF(calibration, uchar, PF_MASK_PLANE) + offset_of(calibration, place));
    pair.left.good = good.left;
    pair.right.good = good.right;
  }
#endif
  return pair;
}

typedef struct {
  Sensel left;
  Sensel right;
} SenselPair;

/* Loads one row of sensels under PF_LANES pillars, and applies the stages before neighbours count.
 */
PF_INLINE SenselPair read_linear(global const PF_SENSEL* raw, Calibration calibration,
                                 Place place) {
  const CountsPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, place);
  SenselPair pair;
  pair.left = linear_sensel(readings.left, at.left, calibration.stages);
  pair.right = linear_sensel(readings.right, at.right, calibration.stages);
  return pair;
}

/* Applies the stages after neighbours and earlier frames. */
PF_INLINE SenselPair finish_sensels(SenselPair pair, Calibration calibration, Place place) {
  const CorrectionPair at = load_corrections(calibration, place);
  pair.left = active_sensel(pair.left, at.left, calibration.stages);
  pair.right = active_sensel(pair.right, at.right, calibration.stages);
  return pair;
}

#ifdef PF_UNCERTAINTY
/* Noise of one row of sensels under PF_LANES pillars after correction, counts. */
PF_INLINE RealPair read_noise(global const PF_SENSEL* raw, Calibration calibration, Place place) {
  const CountsPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, place);
  const Stages stages = calibration.stages;
  RealPair noise = {PF_VALUE(Real, noise), PF_VALUE(Real, noise)};
  if (PF_HAS_NOISE_PLANE) {
    noise =
        load_plane(PF_PLANE_OF(calibration, float, PF_NOISE_PLANE) + offset_of(calibration, place));
  }
  noise.left = corrected_noise(noise.left, readings.left, at.left, calibration.stages);
  noise.right = corrected_noise(noise.right, readings.right, at.right, calibration.stages);
  return noise;
}
#endif

#define PF_PREFETCH_PLANE(type, plane) \
  PF_PREFETCH(PF_PLANE_OF(calibration, type, plane) + offset + row * calibration.stride)

/* Prefetches the calibration of two rows of sensels under a block that is solved later: hardware
 * prefetching stops at the end of a page. */
PF_INLINE void prefetch_planes(Calibration calibration, size_t offset) {
  for (uint row = 0; row < 2; ++row) {
#ifdef PF_TARE
    if (PF_NAMED(tare)) PF_PREFETCH_PLANE(float, PF_TARE_PLANE);
#endif
#ifdef PF_GAIN
    if (PF_NAMED(gain)) PF_PREFETCH_PLANE(float, PF_GAIN_PLANE);
#endif
#ifdef PF_DEAD_ZONE
    if (PF_NAMED(dead_zone)) PF_PREFETCH_PLANE(float, PF_DEAD_ZONE_PLANE);
#endif
#ifdef PF_MASK
    if (PF_NAMED(mask)) PF_PREFETCH_PLANE(uchar, PF_MASK_PLANE);
#endif
    if (PF_HAS_NOISE_PLANE) PF_PREFETCH_PLANE(float, PF_NOISE_PLANE);
  }
}

/* A range of pillar rows. */
typedef struct {
  uint number; /* 0 is the uppermost */
  uint first;
  uint end;
} Band;

/* One of get_global_size(1) bands of nearly equal height. */
PF_INLINE Band band_of(uint number, uint rows) {
  const ulong bands = get_global_size(1);
  const Band band = {number, (uint)((ulong)number * rows / bands),
                     (uint)((number + 1ul) * rows / bands)};
  return band;
}

/* Pillar rows of this work-item. Even bands come before odd ones: PoCL gives its first thread the
 * first half of the work-groups at once, and a contact that lies in one half of the skin would keep
 * the other threads idle. */
PF_INLINE Band band_of_rows(uint rows) {
  const uint even = (uint)((get_global_size(1) + 1) / 2);
  const uint at = (uint)get_global_id(1);
  return band_of(at < even ? 2 * at : 2 * (at - even) + 1, rows);
}

/* Largest number of blocks in a pillar row, whatever its first index. */
PF_INLINE uint blocks_of_row(uint cols) { return cols / PF_LANES + 2; }

/* The calibration of a frame; `results` holds what earlier entry points found. */
PF_INLINE Calibration calibration_of(global const uchar* planes, global uchar* results,
                                     Layout layout, Stages stages) {
  Calibration calibration;
  calibration.planes = planes;
  calibration.plane_bytes = layout.plane_bytes;
  calibration.stride = layout.plane_stride;
  calibration.stages = stages;
  calibration.frame = (uint)layout.frame;
#ifdef PF_WIRES
  calibration.wires = wire_vectors((global float*)(results + layout.wires), 2 * (uint)layout.rows,
                                   2 * (uint)layout.cols);
#endif
  return calibration;
}
