/* The sensels next to a pillar, for stages that need them: those under it and a ring of one
 * around. With several lanes a work-item keeps the three pillar rows of sensels that it needs at a
 * time, so that each is read and corrected once for each band; with one lane, which shares a row
 * with other work-items, it corrects them again. Sensels outside the skin leak nothing. Stage
 * PF_LEAK. */
#ifdef PF_LEAK

/* Values of the 4 x 4 sensels around PF_LANES pillars: rows from above, columns from the left. */
typedef struct {
  Real at[4][4];
} Surroundings;

/* The leak sources in one row of sensels under PF_LANES pillars. */
PF_INLINE RealPair leak_sources(global const PF_SENSEL* raw, Calibration calibration, Place place) {
  const Stages stages = calibration.stages;
  const Real threshold = PF_VALUE(Real, threshold);
  const SenselPair pair = read_linear(raw, calibration, place);
  const Real left = leak_source(pair.left, threshold);
  const Real right = leak_source(pair.right, threshold);
  const RealPair sources = {source_or(pair.left, left, right), source_or(pair.right, right, left)};
  return sources;
}

#ifdef PF_RING

/* Sources of the upper (down 0) or lower sensels of a pillar row, left or right ones, with a zero
 * before and after them. */
PF_INLINE global float* ring_row(Ring ring, uint row, uint down, uint right) {
  return ring.values + (4 * place_in_ring(row) + 2 * down + right) * ring.stride + 1;
}

/* This work-item's ring, whose rows may hold anything. */
PF_INLINE Ring ring_of(global float* rings, uint cols) {
  Ring ring;
  ring.stride = cols + 2;
  ring.blocks = blocks_of_row(cols);
  ring.written = (1 << PF_RING_ROWS) - 1;
  const size_t floats = 4 * PF_RING_ROWS * ring.stride;
  ring.values = rings + get_global_id(1) * floats;
  ring.idle = (global uchar*)(rings + get_global_size(1) * floats) +
              get_global_id(1) * PF_RING_ROWS * ring.blocks;
  return ring;
}

/* Finds the idle blocks of a row; how many are not. */
PF_INLINE uint find_idle_blocks(Row row, global uchar* flags) {
  uint active = 0;
  bool idle = true;
  for (uint at = 0; at < row.blocks; ++at) {
#ifdef PF_SKIP_IDLE
    idle = readings_are_idle(row, 2 * col_of_block(row, at), idle);
#else
    idle = false;
#endif
    flags[at] = idle ? 1 : 0;
    active += idle ? 0 : 1;
  }
  return active;
}

/* Writes the sources of the blocks of a row that are not idle. */
PF_INLINE void fill_ring_blocks(Input input, Row row, global const uchar* idle, uint at_row) {
  for (uint at = 0; at < row.blocks; ++at) {
    if (at + 8 <= row.blocks && eight_flags(idle + at) == PF_EIGHT_IDLE) at += 8;
    if (at == row.blocks) return;
    if (idle[at]) continue;
    const uint col = col_of_block(row, at);
    for (uint down = 0; down < 2; ++down) {
      const Place place = {2 * at_row + down, 2 * col};
      const RealPair sources =
          leak_sources(row.raw + down * row.row_stride + 2 * col, input.calibration, place);
      PF_STORE_WHOLE(float, sources.left, ring_row(input.ring, at_row, down, 0) + col);
      PF_STORE_WHOLE(float, sources.right, ring_row(input.ring, at_row, down, 1) + col);
    }
  }
}

/* Writes zeros to a row, or only before and after it. */
PF_INLINE void clear_ring_row(Ring ring, uint row, bool whole) {
  global float* const first = ring_row(ring, row, 0, 0) - 1;
  const size_t count = 4 * ring.stride;
  for (size_t i = 0; whole && i < count; i += PF_LANES) {
    PF_STORE_WHOLE(float, PF_CONSTANT(Real, 0.0f), first + min(i, count - PF_LANES));
  }
  for (size_t i = 0; i < count; i += ring.stride) first[i] = first[i + ring.stride - 1] = 0.0f;
}

/* Writes the sources of a pillar row, which may lie outside the skin (-1 and beyond the last). */
PF_INLINE void fill_ring_row(Input* input, global uchar* idle, uint at_row) {
  const uint bit = 1u << place_in_ring(at_row);
  const bool outside = at_row >= input->rows;
  const Row row = row_of(*input, idle, outside ? 0 : at_row);
  const uint active = outside ? 0 : find_idle_blocks(row, idle_in_ring(input->ring, at_row));
  if (input->ring.written & bit) clear_ring_row(input->ring, at_row, active < row.blocks);
  input->ring.written &= ~bit;
  if (active == 0) return;
  fill_ring_blocks(*input, row, idle_in_ring(input->ring, at_row), at_row);
  input->ring.written |= bit;
}

/* Fills the rows around pillar row `row` that the ring does not have yet. */
PF_INLINE void fill_ring(Input* input, global uchar* idle, uint row, bool first) {
  for (uint at = first ? row - 1 : row + 1; at != row + 2; ++at) fill_ring_row(input, idle, at);
}

PF_INLINE Surroundings surroundings_of(Block block, Input input) {
  const uint col = block.top.col / 2;
  Surroundings around;
  PF_UNROLL
  for (uint i = 0; i < 4; ++i) {
    const uint row = block.top.row / 2 + (i + 1) / 2 - 1;
    global const float* const left = ring_row(input.ring, row, (i + 1) % 2, 0) + col;
    global const float* const right = ring_row(input.ring, row, (i + 1) % 2, 1) + col;
    around.at[i][0] = PF_LOAD_WHOLE(float, right - 1);
    around.at[i][1] = PF_LOAD_WHOLE(float, left);
    around.at[i][2] = PF_LOAD_WHOLE(float, right);
    around.at[i][3] = PF_LOAD_WHOLE(float, left + 1);
  }
  return around;
}

/* The sensels of a row as the ring has them: zero where they are at most the threshold. */
PF_INLINE SenselPair pair_in_ring(SenselPair pair, Surroundings around, uint side) {
  pair.left.reading = around.at[side + 1][1];
  pair.right.reading = around.at[side + 1][2];
  return pair;
}

#else

/* Sources of the pillar at `col`, in the row of sensels `row`; zero outside the skin. */
PF_INLINE RealPair sources_at(Input input, uint row, uint col) {
  RealPair none = {PF_CONSTANT(Real, 0.0f), PF_CONSTANT(Real, 0.0f)};
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

/* V of the neighbours of the sensel in row `row` and column `col` of the pillars. */
PF_INLINE Neighbours neighbours_of(Surroundings around, int row, int col) {
#define PF_AT(down, right) around.at[row + 1 + (down)][col + 1 + (right)]
  const Neighbours neighbours = PF_NEIGHBOURS(PF_AT, inward(row), inward(col));
#undef PF_AT
  return neighbours;
}

/* Removes what the upper (side 0) or lower (side 1) sensels of PF_LANES pillars receive. */
PF_INLINE SenselPair without_leak(SenselPair pair, Surroundings around, int side, Stages stages) {
  const Real threshold = PF_VALUE(Real, threshold);
  const LeakTaps taps = leak_taps(stages);
  pair.left = remove_leak(pair.left, neighbours_of(around, side, 0), taps, threshold);
  pair.right = remove_leak(pair.right, neighbours_of(around, side, 1), taps, threshold);
  return pair;
}

#endif
