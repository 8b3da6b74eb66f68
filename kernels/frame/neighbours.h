/* The sensels next to a pillar, for stages that need them: those under it and a ring of one around.
 * With several lanes a work-item keeps the four rows of sensels that it needs at a time, so that
 * each is corrected once for each band; with one lane, which shares a row with other work-items, it
 * corrects them anew. Sensels outside the skin leak nothing. Stage PF_LEAK. */
#ifdef PF_LEAK

/* Values of the 4 x 4 sensels around PF_LANES pillars: rows from above, columns from the left. */
typedef struct {
  Real at[4][4];
} Surroundings;

/* What one row of sensels under PF_LANES pillars leaks. */
PF_INLINE RealPair leak_sources(global const PF_SENSEL* raw, Calibration calibration, Place place) {
  const Real threshold = (Real)(PF_THRESHOLD);
  const SenselPair pair = read_linear(raw, calibration, place);
  const Real left = leak_source(pair.left, threshold);
  const Real right = leak_source(pair.right, threshold);
  const RealPair sources = {source_or(pair.left, left, right), source_or(pair.right, right, left)};
  return sources;
}

#if PF_LANES > 1

#define PF_RING_ROWS 4

/* Four rows of sources, left and right sensels apart, each with a zero before and after it. Row r
 * of the skin has the place (r + 1) % 4. */
PF_INLINE global float* ring_row(Ring ring, uint row, uint side) {
  return ring.values + ((row + 1) % PF_RING_ROWS * 2 + side) * ring.stride + 1;
}

/* This work-item's ring. */
PF_INLINE Ring ring_of(global float* rings, uint cols) {
  Ring ring;
  ring.stride = cols + 2;
  ring.values = rings + get_global_id(1) * (2 * PF_RING_ROWS) * ring.stride;
  return ring;
}

/* Prefetches the readings two rows of sensels below, which the ring needs next, with their
 * thresholds. */
PF_INLINE void prefetch_row_below(Input input, Place place) {
  PF_PREFETCH_FAR(input.raw + (place.row + 2) * input.row_stride + place.col);
#ifdef PF_ACTIVATION_PLANE
  PF_PREFETCH_FAR(activation_thresholds(input.calibration) + offset_of(input.calibration, place) +
                  2 * input.calibration.stride);
#endif
}

/* True if no sensel of one row under PF_LANES pillars is active, as far as raw readings tell. */
PF_INLINE bool leaks_nothing(Input input, Place place) {
  global const PF_SENSEL* const raw = input.raw + place.row * input.row_stride + place.col;
#if defined(PF_SKIP_IDLE) && defined(PF_WIRES)
  const float bound = bound_of(input.calibration.wires, place, 1);
  if (bound == PF_IDLE_TILE) return true;
  prefetch_row_below(input, place);
  return rows_are_idle(raw, 0, input.calibration, place, 1, bound);
#elif defined(PF_SKIP_IDLE)
  prefetch_row_below(input, place);
  return row_is_idle(
      raw, activation_thresholds(input.calibration) + offset_of(input.calibration, place));
#else
  return false;
#endif
}

/* Writes the sources of row `row`, which may lie outside the skin (-1 and beyond the last), and of
 * its ends. */
PF_INLINE void fill_ring_row(Input input, uint row) {
  global float* const left = ring_row(input.ring, row, 0);
  global float* const right = ring_row(input.ring, row, 1);
  left[-1] = right[-1] = left[input.cols] = right[input.cols] = 0.0f;
  const bool outside = row >= 2 * input.rows;
  for (uint at = 0; at < input.cols; at += PF_LANES) {
    const uint col = min(at, input.cols - PF_LANES);
    const Place place = {row, 2 * col};
    RealPair sources = {(Real)(0.0f), (Real)(0.0f)};
    if (!outside && !leaks_nothing(input, place)) {
      sources =
          leak_sources(input.raw + row * input.row_stride + 2 * col, input.calibration, place);
    }
    PF_STORE_WHOLE(float, sources.left, left + col);
    PF_STORE_WHOLE(float, sources.right, right + col);
  }
}

/* Fills the rows around pillar row `row` that the ring does not have yet. */
PF_INLINE void fill_ring(Input input, uint row, bool first) {
  if (first) {
    fill_ring_row(input, 2 * row - 1);
    fill_ring_row(input, 2 * row);
  }
  fill_ring_row(input, 2 * row + 1);
  fill_ring_row(input, 2 * row + 2);
}

PF_INLINE Surroundings surroundings_of(Block block, Input input) {
  const uint col = block.top.col / 2;
  Surroundings around;
  PF_UNROLL
  for (uint i = 0; i < 4; ++i) {
    global const float* const left = ring_row(input.ring, block.top.row + i - 1, 0) + col;
    global const float* const right = ring_row(input.ring, block.top.row + i - 1, 1) + col;
    around.at[i][0] = PF_LOAD_WHOLE(float, right - 1);
    around.at[i][1] = PF_LOAD_WHOLE(float, left);
    around.at[i][2] = PF_LOAD_WHOLE(float, right);
    around.at[i][3] = PF_LOAD_WHOLE(float, left + 1);
  }
  return around;
}

#else

PF_INLINE Ring ring_of(global float* rings, uint cols) {
  const Ring ring = {rings, cols};
  return ring;
}

PF_INLINE void fill_ring(Input input, uint row, bool first) {}

/* Sources of the pillar at `col`, in the row of sensels `row`; zero outside the skin. */
PF_INLINE RealPair sources_at(Input input, uint row, uint col) {
  RealPair none = {(Real)(0.0f), (Real)(0.0f)};
  if (row >= 2 * input.rows || col >= input.cols) return none;
  const Place place = {row, 2 * col};
  return leak_sources(input.raw + row * input.row_stride + 2 * col, input.calibration, place);
}

PF_INLINE Surroundings surroundings_of(Block block, Input input) {
  const uint col = block.top.col / 2;
  Surroundings around;
  PF_UNROLL
  for (uint i = 0; i < 4; ++i) {
    const uint row = block.top.row + i - 1;
    const RealPair own = sources_at(input, row, col);
    around.at[i][0] = sources_at(input, row, col - 1).right;
    around.at[i][1] = own.left;
    around.at[i][2] = own.right;
    around.at[i][3] = sources_at(input, row, col + 1).left;
  }
  return around;
}

#endif

PF_INLINE LeakTaps leak_taps(void) {
  LeakTaps taps;
  taps.self = (Real)(PF_LEAK_SELF);
  taps.inside = (Real)(PF_LEAK_INSIDE);
  taps.across = (Real)(PF_LEAK_ACROSS);
  taps.both_inside = (Real)(PF_LEAK_BOTH_INSIDE);
  taps.mixed = (Real)(PF_LEAK_MIXED);
  taps.both_across = (Real)(PF_LEAK_BOTH_ACROSS);
  return taps;
}

/* Removes what the upper (side 0) or lower (side 1) sensels of PF_LANES pillars receive. */
PF_INLINE SenselPair without_leak(SenselPair pair, Surroundings around, uint side) {
  const Real threshold = (Real)(PF_THRESHOLD);
  const uint row = side == 0 ? 1 : 2;
  const uint in = side == 0 ? 2 : 1;
  const uint out = side == 0 ? 0 : 3;
#define PF_NEIGHBOURS(col, in_col, out_col)                                                   \
  {                                                                                           \
    around.at[row][in_col], around.at[in][col], around.at[row][out_col], around.at[out][col], \
        around.at[in][in_col], around.at[out][in_col], around.at[in][out_col],                \
        around.at[out][out_col]                                                               \
  }
  const Neighbours left = PF_NEIGHBOURS(1, 2, 0);
  const Neighbours right = PF_NEIGHBOURS(2, 1, 3);
#undef PF_NEIGHBOURS
  pair.left = remove_leak(pair.left, left, leak_taps(), threshold);
  pair.right = remove_leak(pair.right, right, leak_taps(), threshold);
  return pair;
}

#endif
