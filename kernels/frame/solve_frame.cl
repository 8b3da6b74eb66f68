/* Solves a frame: readings in, forces and status bytes out. Only indexing, loading, calling and
 * storing; the mathematics is in pillar/.
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
 *   PF_TARE, PF_GAIN, PF_DEAD_ZONE, PF_MASK   stages: the calibration plane of that name is read
 *   PF_POWER_EXPONENT               stage: readings are straightened by a power law, with
 *   PF_POWER_REFERENCE, PF_POWER_LARGEST      counts
 *   PF_PAPER                        stage: the paper's estimator instead of the direct solve
 *   PF_SEGMENT_POINT                where on a segment the force is reported, in (0, 1]; with
 *                                   PF_WHOLE the number n of 1 - 1 / 2^n
 *   PF_DOUBT                        counts by which noise may shift what parity says
 *   PF_PARITY_TOLERANCE             counts; stage: the parity test
 *   PF_ANGLES                       stage: magnitude, theta and phi are written too
 *   PF_UNCERTAINTY                  noise of a raw reading, counts; stage: uncertainty is written
 *   PF_NOISE                        with PF_UNCERTAINTY: the noise is read from its plane instead
 *   PF_HALF                         stage: results other than status are of half precision
 *   PF_BASELINE                     stage: follow_baseline.cl
 *   PF_STREAM                       results go past the caches: load_store.h
 *   PF_SKIP_SILENT                  silent blocks are left as they are: silence.h
 *   PF_WAKE_PLANE or PF_WAKE        readings that wake a sensel, each its own or one for all
 *
 * A stage that is not named leaves no trace. Constants are exact (hexadecimal); with PF_WHOLE those
 * in counts are whole numbers of its unit. */

PF_INLINE Force estimate(Pillar pillar, Diagonals diagonals, ParitySum sum) {
  const ForceScale scale = {(Real)(PF_SHEAR_SCALE), (Real)(PF_NORMAL_SCALE)};
#ifdef PF_PAPER
  return paper_force(pillar, diagonals, sum, scale);
#else
  return direct_force(diagonals, sum, scale);
#endif
}

PF_INLINE Bits status_of(Pillar pillar, Diagonals diagonals, ParitySum sum) {
  Bits status = direct_status(pillar, diagonals, sum, (Counts)(PF_DOUBT));
#ifdef PF_PARITY_TOLERANCE
  const Bits at_odds = bits_of(fails_parity(pillar, sum, (Counts)(PF_PARITY_TOLERANCE)));
  status = status | (at_odds & PF_BITS(PF_STATUS_INCONSISTENT));
#endif
  return status;
}

/* Where a frame comes from, and the results go: the arguments of the entry point. */
typedef struct {
  global const PF_SENSEL* raw;
  size_t row_stride;
  Planes planes;
  global const PF_SENSEL* wake; /* [rows, stride of the planes], or null */
} Input;

typedef struct {
  global Result* shear_x;
  global Result* shear_y;
  global Result* normal;
  global uchar* status;
  global Result* magnitude;
  global Result* theta;
  global Result* phi;
  global Result* deviation_x;
  global Result* deviation_y;
  global Result* deviation_normal;
  global Result* theta_low;
  global Result* theta_high;
  global Result* phi_low;
  global Result* phi_high;
  global Result* magnitude_low;
  global Result* magnitude_high;
  global uchar* silent; /* of each block: its results are those of silence; or null */
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

/* What is solved of the pillars of a block. */
typedef struct {
  Force force;
  Bits status;
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  Direction direction;
#endif
#ifdef PF_UNCERTAINTY
  Force deviations;
  DirectionInterval interval;
#endif
} Solution;

#ifdef PF_UNCERTAINTY
PF_INLINE Noise noise_of(Block block, Input input) {
  const Planes planes = input.planes;
  const RealPair top = read_noise(block.raw, planes, block.offset);
  const RealPair bottom =
      read_noise(block.raw + input.row_stride, planes, block.offset + planes.stride);
  const Noise noise = {top.right, top.left, bottom.left, bottom.right};
  return noise;
}
#endif

/* From corrected sensels to the results. */
PF_INLINE Solution solve_pillars(Pillar pillar, Block block, Input input) {
  const Diagonals diagonals = pillar_diagonals(pillar);
  const ParitySum sum = parity_sum(diagonals, (Fraction)(PF_SEGMENT_POINT));
  Solution solution;
  solution.force = estimate(pillar, diagonals, sum);
  solution.status = status_of(pillar, diagonals, sum);
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  solution.direction = direction_of(solution.force);
#endif
#ifdef PF_UNCERTAINTY
  const ForceScale scale = {(Real)(PF_SHEAR_SCALE), (Real)(PF_NORMAL_SCALE)};
  solution.deviations = force_deviations(pillar, diagonals, sum, noise_of(block, input),
                                         (Real)(PF_SEGMENT_POINT), scale);
  solution.interval = direction_interval(pillar, diagonals, sum, solution.direction, scale);
#endif
  return solution;
}

/* The sensel, of which is known in every lane that it is neither missing nor saturated. */
PF_INLINE Sensel sound_sensel(Sensel sensel) {
  const Mask none = (Mask)(0);
  sensel.missing = none;
  sensel.saturated = none;
  return sensel;
}

PF_INLINE Mask is_unsound(Sensel sensel) { return sensel.missing || sensel.saturated; }

/* Most blocks have no missing and no saturated sensel. For them the compiler gets the same text
 * with those masks false, and leaves half of it out. */
PF_INLINE Solution solve_block(Block block, Input input) {
  const Planes planes = input.planes;
  const SenselPair top = read_sensels(block.raw, planes, block.offset);
  const SenselPair bottom =
      read_sensels(block.raw + input.row_stride, planes, block.offset + planes.stride);
  const Pillar pillar = {top.right, top.left, bottom.left, bottom.right};
#if PF_LANES > 1 && (defined(PF_MASK) || defined(PF_FULL_SCALE) || defined(PF_LARGEST_READING))
  const Mask unsound = is_unsound(pillar.s1) || is_unsound(pillar.s2) || is_unsound(pillar.s3) ||
                       is_unsound(pillar.s4);
  if (!any_lane(unsound)) {
    const Pillar sound = {sound_sensel(pillar.s1), sound_sensel(pillar.s2), sound_sensel(pillar.s3),
                          sound_sensel(pillar.s4)};
    return solve_pillars(sound, block, input);
  }
#endif
  return solve_pillars(pillar, block, input);
}

/* Writes the results of `lanes` from pillar `index` on. */
PF_INLINE void store_lanes(Solution solution, Output output, size_t index, Lanes lanes) {
  store_plane(solution.force.shear_x, output.shear_x + index, lanes);
  store_plane(solution.force.shear_y, output.shear_y + index, lanes);
  store_plane(solution.force.normal, output.normal + index, lanes);
  store_status(solution.status, output.status + index, lanes);
#ifdef PF_ANGLES
  store_plane(solution.direction.magnitude, output.magnitude + index, lanes);
  store_plane(solution.direction.theta, output.theta + index, lanes);
  store_plane(solution.direction.phi, output.phi + index, lanes);
#endif
#ifdef PF_UNCERTAINTY
  store_plane(solution.deviations.shear_x, output.deviation_x + index, lanes);
  store_plane(solution.deviations.shear_y, output.deviation_y + index, lanes);
  store_plane(solution.deviations.normal, output.deviation_normal + index, lanes);
  store_plane(solution.interval.theta_low, output.theta_low + index, lanes);
  store_plane(solution.interval.theta_high, output.theta_high + index, lanes);
  store_plane(solution.interval.phi_low, output.phi_low + index, lanes);
  store_plane(solution.interval.phi_high, output.phi_high + index, lanes);
  store_plane(solution.interval.magnitude_low, output.magnitude_low + index, lanes);
  store_plane(solution.interval.magnitude_high, output.magnitude_high + index, lanes);
#endif
}

/* The same; asked once for all planes whether the block is whole, which nearly all are. */
PF_INLINE void store_solution(Solution solution, Output output, size_t index, Lanes lanes) {
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
  size_t wake_stride;
  global uchar* silent; /* the mark of the first block */
  uint skew;            /* pillars by which the first block would begin before the row */
  uint last_col;        /* where the last block begins */
  uint blocks;
} Row;

PF_INLINE uint col_of_block(Row row, uint at) {
  return min(max(at * PF_LANES, row.skew) - row.skew, row.last_col);
}

/* Prefetches the readings of the pillar row below, and their levels; `sensel` counts from the first
 * of the row. What is silent here is silent there, mostly. */
PF_INLINE void prefetch_readings(Row row, size_t sensel, bool silent) {
  if (silent) {
    PF_PREFETCH_FAR(row.raw + sensel + 2 * row.row_stride);
    PF_PREFETCH_FAR(row.raw + sensel + 3 * row.row_stride);
  } else {
    PF_PREFETCH(row.raw + sensel + 2 * row.row_stride);
    PF_PREFETCH(row.raw + sensel + 3 * row.row_stride);
  }
#ifdef PF_WAKE_PLANE
  PF_PREFETCH_FAR(row.wake + sensel + 2 * row.wake_stride);
  PF_PREFETCH_FAR(row.wake + sensel + 3 * row.wake_stride);
#endif
}

/* Whether a block's results are those of silence already; if not, notes what they are now to be. */
PF_INLINE bool may_skip(Row row, uint at, size_t sensel) {
#ifdef PF_SKIP_SILENT
  const bool was_silent = row.silent[at];
  prefetch_readings(row, sensel, was_silent);
  const bool silent =
      is_silent(row.raw + sensel, row.row_stride, row.wake + sensel, row.wake_stride);
  if (silent != was_silent) row.silent[at] = silent;
  return silent && was_silent;
#else
  prefetch_readings(row, sensel, false);
  return false;
#endif
}

/* The first block from `at` on, of this work-item's, that is to be solved. */
PF_INLINE uint next_awake(Row row, uint at) {
  const uint step = (uint)get_global_size(0);
  while (at < row.blocks && may_skip(row, at, 2 * col_of_block(row, at))) at += step;
  return at;
}

/* The lanes of the block at `col` that no other block of its row writes. `place` is where it would
 * begin, `skew` before the row's first pillar. */
PF_INLINE Lanes own_lanes(uint place, uint skew, uint col, uint cols) {
  const uint first = max(place, skew) - skew;
  const uint end = min(place + PF_LANES - skew, cols);
  const Lanes lanes = {first - col, end - col};
  return lanes;
}

/* Solves the blocks of a pillar row that are this work-item's. */
PF_INLINE void solve_row(Input input, Output output, uint at_row, uint pillar_cols) {
  const size_t first_index = (size_t)at_row * pillar_cols;
  const size_t first_offset = 2 * at_row * input.planes.stride;
  const uint skew = (uint)(first_index % PF_LANES);
  const Row row = {input.raw + 2 * at_row * input.row_stride,
                   input.wake + first_offset,
                   input.row_stride,
                   input.planes.stride,
                   output.silent + (size_t)at_row * blocks_of_row(pillar_cols),
                   skew,
                   pillar_cols - PF_LANES,
                   (skew + pillar_cols + PF_LANES - 1) / PF_LANES};
  const uint step = (uint)get_global_size(0);
  for (uint at = next_awake(row, (uint)get_global_id(0)); at < row.blocks;
       at = next_awake(row, at + step)) {
    const uint col = col_of_block(row, at);
    const size_t offset = first_offset + 2 * col;
    prefetch_planes(input.planes, offset + 2 * input.planes.stride);
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
 * raw           readings, `row_stride` apart from one row of sensels to the next
 * tare .. wake  calibration planes [rows, plane_stride], or null
 * silent        [pillar_rows, blocks_of_row(pillar_cols)], zero at first, or null
 * shear_x ..    results [pillar_rows, pillar_cols]; those from magnitude on may be null */
kernel void solve_frame(global const PF_SENSEL* restrict raw, ulong row_stride, uint pillar_rows,
                        uint pillar_cols, global const float* restrict tare,
                        global const float* restrict gain, global const float* restrict dead_zone,
                        global const uchar* restrict mask, global const float* restrict noise,
                        global const PF_SENSEL* restrict wake, ulong plane_stride,
                        global uchar* restrict silent, global Result* restrict shear_x,
                        global Result* restrict shear_y, global Result* restrict normal,
                        global uchar* restrict status, global Result* restrict magnitude,
                        global Result* restrict theta, global Result* restrict phi,
                        global Result* restrict deviation_x, global Result* restrict deviation_y,
                        global Result* restrict deviation_normal, global Result* restrict theta_low,
                        global Result* restrict theta_high, global Result* restrict phi_low,
                        global Result* restrict phi_high, global Result* restrict magnitude_low,
                        global Result* restrict magnitude_high) {
  const Planes planes = {tare, gain, dead_zone, mask, noise, plane_stride};
  const Input input = {raw, row_stride, planes, wake};
  const Output output = {shear_x,        shear_y,    normal,      status,      magnitude,
                         theta,          phi,        deviation_x, deviation_y, deviation_normal,
                         theta_low,      theta_high, phi_low,     phi_high,    magnitude_low,
                         magnitude_high, silent};
  const Band band = band_of_rows(pillar_rows);
  for (uint row = band.first; row < band.end; ++row) solve_row(input, output, row, pillar_cols);
}
