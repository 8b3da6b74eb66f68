/* The blocks of a pillar row, and which of them are idle. */

/* A row of pillars, and the blocks into which it is divided. Blocks begin at results aligned to
 * PF_LANES, so that stores do not straddle cache lines. The first and the last block are shifted
 * into the row and overlap their neighbours; both write equal results. With PF_STREAM each cache
 * line must be written once. */
typedef struct {
  global const PF_SENSEL* raw;        /* the first sensel */
  global const PF_SENSEL* activation; /* its activation threshold */
  size_t row_stride;
  size_t activation_stride;
  Stages stages;
  global uchar* idle; /* flag of the first block, of the frame before too */
#ifdef PF_RING
  global const uchar* idle_now; /* flag of the first block in the ring */
#endif
  uint skew;     /* pillars by which the first block would begin before the row */
  uint last_col; /* first column of the last block */
  uint blocks;
#ifdef PF_WIRES
  Calibration calibration;
  uint sensel_row;
#endif
} Row;

PF_INLINE uint col_of_block(Row row, uint at) {
  return min(max(at * PF_LANES, row.skew) - row.skew, row.last_col);
}

/* Prefetches the readings of the pillar row below and their activation thresholds; `sensel` counts
 * from the first of the row. Below an idle block there is mostly another one, and idle rows pass
 * faster than memory answers: for them two rows ahead. */
PF_INLINE void prefetch_readings(Row row, size_t sensel, bool idle) {
  if (idle) {
    PF_PREFETCH_FAR(row.raw + sensel + 4 * row.row_stride);
    PF_PREFETCH_FAR(row.raw + sensel + 5 * row.row_stride);
  } else {
    PF_PREFETCH(row.raw + sensel + 2 * row.row_stride);
    PF_PREFETCH(row.raw + sensel + 3 * row.row_stride);
  }
#ifdef PF_ACTIVATION_PLANE
  PF_PREFETCH_FAR(row.activation + sensel + 2 * row.activation_stride);
  PF_PREFETCH_FAR(row.activation + sensel + 3 * row.activation_stride);
#endif
}

#ifdef PF_SKIP_IDLE
/* True if a block is idle, as far as raw readings tell. */
PF_INLINE bool readings_are_idle(Row row, size_t sensel, bool was_idle) {
#ifdef PF_WIRES
  if (PF_NAMED(wires)) {
    const Place place = {row.sensel_row, (uint)sensel};
    const float bound = bound_of(row.calibration.wires, place);
    if (bound == PF_IDLE_TILE) return true;
    prefetch_readings(row, sensel, was_idle);
    return is_idle(row.raw + sensel, row.row_stride, row.activation + sensel, row.activation_stride,
                   row.stages) &&
           rows_are_idle(row.raw + sensel, row.row_stride, row.calibration, place, bound);
  }
#endif
  prefetch_readings(row, sensel, was_idle);
  return is_idle(row.raw + sensel, row.row_stride, row.activation + sensel, row.activation_stride,
                 row.stages);
}

/* The same of block `at`; the ring knows it. */
PF_INLINE bool block_is_idle(Row row, uint at, size_t sensel) {
#ifdef PF_RING
  if (PF_NAMED(leak)) return row.idle_now[at] != 0;
#endif
  return readings_are_idle(row, sensel, row.idle[at] != 0);
}
#endif

PF_INLINE Row row_of(Input input, global uchar* idle, uint at_row) {
  const Calibration calibration = input.calibration;
  const uint cols = input.cols;
  Row row;
  row.raw = input.raw + 2 * at_row * input.row_stride;
  row.activation = activation_thresholds(calibration) + 2 * at_row * calibration.stride;
  row.row_stride = input.row_stride;
  row.activation_stride = calibration.stride;
  row.stages = calibration.stages;
  row.idle = idle + (size_t)at_row * blocks_of_row(cols);
#ifdef PF_RING
  if (PF_NAMED(leak)) row.idle_now = idle_in_ring(input.ring, at_row);
#endif
  row.skew = (uint)((size_t)at_row * cols % PF_LANES);
#ifdef PF_SENSELS
  if (PF_NAMED(sensel_force)) row.skew = 0;
#endif
  row.last_col = cols - PF_LANES;
  row.blocks = (row.skew + cols + PF_LANES - 1) / PF_LANES;
#ifdef PF_WIRES
  row.calibration = calibration;
  row.sensel_row = 2 * at_row;
#endif
  return row;
}
