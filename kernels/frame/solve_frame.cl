/* Solves a frame: readings in, forces and status bytes out. Only indexing, loading, calling and
 * storing; the mathematics is in pillar/, the order of the stages in stages.h.
 *
 * The host writes what a plan asks for as the first lines of the program:
 *
 *   PF_LANES                        pillars that a work-item solves at once: 1, 2, 4, 8, 16, and
 *                                   no more than a row has
 *   PF_SENSEL                       uchar, ushort or float
 *   PF_WHOLE                        counts are whole numbers of 1 / PF_WHOLE counts: portable.h
 *   PF_SHEAR_SCALE, PF_NORMAL_SCALE newtons per count, or per that unit (ForceScale)
 *   PF_THRESHOLD                    counts
 *   PF_LARGEST_READING              counts; stage: readings beyond, and NaN, are missing
 *   PF_FULL_SCALE                   counts; stage: saturation
 *   PF_TARE, PF_GAIN, PF_DEAD_ZONE, PF_MASK   stages: the calibration plane of that name is read,
 *   PF_TARE_PLANE, ...              so many planes after the first
 *   PF_POWER_EXPONENT               stage: readings are straightened by a power law, with
 *   PF_POWER_REFERENCE, PF_POWER_LARGEST      counts
 *   PF_PAPER                        stage: the paper's estimator instead of the direct solve
 *   PF_SEGMENT_POINT                where on a segment the force is reported, in (0, 1]; with
 *                                   PF_WHOLE the number n of 1 - 1 / 2^n
 *   PF_MARGIN                        counts by which noise may shift what parity says
 *   PF_PARITY_TOLERANCE             counts; stage: the parity test
 *   PF_ANGLES                       stage: magnitude, theta and phi are written too
 *   PF_UNCERTAINTY                  noise of a raw reading, counts; stage: uncertainty is written
 *   PF_NOISE                        with PF_UNCERTAINTY: the noise is read from its plane instead
 *   PF_BASELINE                     stage: follow_baseline.cl
 *   PF_STREAM                       results go past the caches: load_store.h
 *   PF_SKIP_IDLE                  silent blocks are left as they are: silence.h
 *   PF_ACTIVATION_PLANE or PF_ACTIVATION        readings that wake a sensel, each its own or one
 * for all
 *
 * A stage that is not named leaves no trace. Constants are exact (hexadecimal); with PF_WHOLE those
 * in counts are whole numbers of its unit. */

/* Where a frame comes from, and the results go: the arguments of the entry point. */
typedef struct {
  global const PF_SENSEL* raw;
  size_t row_stride;
  Calibration calibration;
} Input;

typedef struct {
  global uchar* planes;
  size_t plane_bytes;
  global uchar* status;
  global uchar* idle; /* of each block: its results are those of silence; or nothing */
} Output;

/* Where the pillars of a block are: `raw` is the sensel at their upper left, `offset` its place in
 * the calibration planes, and `index` that of the first pillar in the results. `lanes` of them
 * are written. */
typedef struct {
  global const PF_SENSEL* raw;
  size_t offset;
  size_t index;
  Lanes lanes;
} Block;

/* The noise of a block's sensels, of use with uncertainty alone. */
PF_FUNCTION Noise noise_of(Block block, Input input) {
#ifdef PF_UNCERTAINTY
  const RealPair top = read_noise(block.raw, input.calibration, block.offset);
  const RealPair bottom = read_noise(block.raw + input.row_stride, input.calibration,
                                     block.offset + input.calibration.stride);
  const Noise noise = {top.right, top.left, bottom.left, bottom.right};
#else
  const Real none = (Real)(0.0f);
  const Noise noise = {none, none, none, none};
#endif
  return noise;
}

/* The sensel, of which is known in every lane that it is neither missing nor saturated. */
PF_FUNCTION Sensel sound_sensel(Sensel sensel) {
  const Mask none = (Mask)(0);
  sensel.missing = none;
  sensel.saturated = none;
  return sensel;
}

PF_FUNCTION Mask is_unsound(Sensel sensel) { return sensel.missing || sensel.saturated; }

/* Most blocks have no missing and no saturated sensel. For them the compiler gets the same text
 * with those masks false, and leaves half of it out. */
PF_FUNCTION Solution solve_block(Block block, Input input) {
  const Calibration calibration = input.calibration;
  const SenselPair top = read_sensels(block.raw, calibration, block.offset);
  const SenselPair bottom =
      read_sensels(block.raw + input.row_stride, calibration, block.offset + calibration.stride);
  const Pillar pillar = {top.right, top.left, bottom.left, bottom.right};
#if PF_LANES > 1 && (defined(PF_MASK) || defined(PF_FULL_SCALE) || defined(PF_LARGEST_READING))
  const Mask unsound = is_unsound(pillar.s1) || is_unsound(pillar.s2) || is_unsound(pillar.s3) ||
                       is_unsound(pillar.s4);
  if (!any_lane(unsound)) {
    const Pillar sound = {sound_sensel(pillar.s1), sound_sensel(pillar.s2), sound_sensel(pillar.s3),
                          sound_sensel(pillar.s4)};
    return solve_pillar(sound, noise_of(block, input), 0);
  }
#endif
  return solve_pillar(pillar, noise_of(block, input), 0);
}

/* Writes the results of `lanes` from pillar `index` on. */
PF_FUNCTION void store_lanes(Solution solution, Output output, size_t index, Lanes lanes) {
  global uchar* plane = output.planes;
#define PF_STORE(name, unit, value)                                   \
  store_plane(solution.value, (global float*)(plane) + index, lanes); \
  plane += output.plane_bytes;
  PF_FORCE_PLANES(PF_STORE)
#ifdef PF_ANGLES
  PF_ANGLE_PLANES(PF_STORE)
#endif
#ifdef PF_UNCERTAINTY
  PF_UNCERTAINTY_PLANES(PF_STORE)
#endif
#undef PF_STORE
  store_status(solution.status, output.status + index, lanes);
}

/* The same; asked once for all planes whether the block is whole, which nearly all are. */
PF_FUNCTION void store_solution(Solution solution, Output output, size_t index, Lanes lanes) {
  const Lanes whole = {0, PF_LANES};
  if (are_all(lanes)) {
    store_lanes(solution, output, index, whole);
  } else {
    store_lanes(solution, output, index, lanes);
  }
}

/* A row of pillars, and the blocks into which it is divided. Blocks begin where a result is on a
 * boundary of PF_LANES, so that stores do not straddle cache lines; the first and the last are
 * moved into the row, and solve again what their neighbours solve as well. Written again it is the
 * same; only past the caches each line must be written once. */
typedef struct {
  global const PF_SENSEL* raw;  /* the first sensel */
  global const PF_SENSEL* wake; /* and its level */
  size_t row_stride;
  size_t activation_stride;
  global uchar* idle; /* the mark of the first block */
  uint skew;          /* pillars by which the first block would begin before the row */
  uint last_col;      /* where the last block begins */
  uint blocks;
} Row;

PF_FUNCTION uint col_of_block(Row row, uint at) {
  return min(max(at * PF_LANES, row.skew) - row.skew, row.last_col);
}

/* Prefetches the readings of the pillar row below, and their levels; `sensel` counts from the first
 * of the row. What is silent here is silent there, mostly. */
PF_FUNCTION void prefetch_readings(Row row, size_t sensel, bool silent) {
  if (silent) {
    PF_PREFETCH_FAR(row.raw + sensel + 2 * row.row_stride);
    PF_PREFETCH_FAR(row.raw + sensel + 3 * row.row_stride);
  } else {
    PF_PREFETCH(row.raw + sensel + 2 * row.row_stride);
    PF_PREFETCH(row.raw + sensel + 3 * row.row_stride);
  }
#ifdef PF_ACTIVATION_PLANE
  PF_PREFETCH_FAR(row.wake + sensel + 2 * row.activation_stride);
  PF_PREFETCH_FAR(row.wake + sensel + 3 * row.activation_stride);
#endif
}

/* Whether a block's results are those of silence already; if not, notes what they are now to be. */
PF_FUNCTION bool may_skip(Row row, uint at, size_t sensel) {
#ifdef PF_SKIP_IDLE
  const bool was_idle = row.idle[at];
  prefetch_readings(row, sensel, was_idle);
  const bool silent =
      is_idle(row.raw + sensel, row.row_stride, row.wake + sensel, row.activation_stride);
  if (silent != was_idle) row.idle[at] = silent;
  return silent && was_idle;
#else
  prefetch_readings(row, sensel, false);
  return false;
#endif
}

/* The first block from `at` on, of this work-item's, that is to be solved. */
PF_FUNCTION uint next_active(Row row, uint at) {
  const uint step = (uint)get_global_size(0);
  while (at < row.blocks && may_skip(row, at, 2 * col_of_block(row, at))) at += step;
  return at;
}

/* The lanes of the block at `col` that no other block of its row writes. `place` is where it would
 * begin, `skew` before the row's first pillar. */
PF_FUNCTION Lanes own_lanes(uint place, uint skew, uint col, uint cols) {
  const uint first = max(place, skew) - skew;
  const uint end = min(place + PF_LANES - skew, cols);
  const Lanes lanes = {first - col, end - col};
  return lanes;
}

/* Solves the blocks of a pillar row that are this work-item's. */
PF_FUNCTION void solve_row(Input input, Output output, uint at_row, uint pillar_cols) {
  const size_t first_index = (size_t)at_row * pillar_cols;
  const Calibration calibration = input.calibration;
  const size_t first_offset = 2 * at_row * calibration.stride;
  const uint skew = (uint)(first_index % PF_LANES);
  const Row row = {input.raw + 2 * at_row * input.row_stride,
                   activation_thresholds(calibration) + first_offset,
                   input.row_stride,
                   calibration.stride,
                   output.idle + (size_t)at_row * blocks_of_row(pillar_cols),
                   skew,
                   pillar_cols - PF_LANES,
                   (skew + pillar_cols + PF_LANES - 1) / PF_LANES};
  const uint step = (uint)get_global_size(0);
  for (uint at = next_active(row, (uint)get_global_id(0)); at < row.blocks;
       at = next_active(row, at + step)) {
    const uint col = col_of_block(row, at);
    const size_t offset = first_offset + 2 * col;
    prefetch_planes(calibration, offset + 2 * calibration.stride);
#ifdef PF_STREAM
    const Lanes lanes = own_lanes(at * PF_LANES, skew, col, pillar_cols);
#else
    const Lanes lanes = {0, PF_LANES};
#endif
    const Block block = {row.raw + 2 * col, offset, first_index + col, lanes};
    store_solution(solve_block(block, input), output, block.index, block.lanes);
  }
}

/* One work-item solves every get_global_size(0)-th block of PF_LANES pillars, in the rows of its
 * band among get_global_size(1).
 *
 * raw          readings, layout.row_stride apart from one row of sensels to the next
 * calibration  its planes, or null
 * results      planes of forces, angles and uncertainty, as the plan asks for them, then the status
 *              and the marks of idle blocks [rows, blocks_of_row(cols)], zero at first */
kernel void solve_frame(global const PF_SENSEL* restrict raw,
                        global const uchar* restrict calibration, global uchar* restrict results,
                        Layout layout) {
  const Calibration planes = {calibration, layout.plane_bytes, layout.plane_stride};
  const Input input = {raw, layout.row_stride, planes};
  const Output output = {results, layout.result_bytes, results + layout.status,
                         results + layout.idle};
  const Band band = band_of_rows((uint)layout.rows);
  for (uint row = band.first; row < band.end; ++row) {
    solve_row(input, output, row, (uint)layout.cols);
  }
}
