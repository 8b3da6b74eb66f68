/* Solves a frame: readings in, forces and status bytes out. This file indexes, loads and stores;
 * the mathematics is in pillar/, the order of the stages in stages.h.
 *
 * The host defines the plan's stages (stage_table.h) in the first lines of the program, and beside
 * them:
 *
 *   PF_LANES                        pillars that a work-item solves at once: 1, 2, 4, 8 or 16
 *   PF_SENSEL                       uchar, ushort or float
 *   PF_WHOLE                        counts are whole numbers of 1 / PF_WHOLE counts: portable.h
 *   PF_TARE_PLANE, ...              indices of the calibration planes
 *   PF_PLAYS, PF_CREEPS             states of a sensel
 *   PF_TILE_ROWS, PF_TILE_COLS      sensels of a tile of wires
 *   PF_NOISE                        with PF_UNCERTAINTY: reads the noise from its plane
 *   PF_STREAM                       results bypass the caches: load_store.h
 *   PF_SKIP_IDLE                    skips idle blocks: idle.h
 *
 * A stage without its macro is not compiled. Numbers are an argument (plan.h); with PF_WHOLE those
 * in counts are multiples of its unit. */

/* Noise of a block's sensels, counts; zero without PF_UNCERTAINTY. */
PF_INLINE Noise noise_of(Block block, Input input) {
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    const RealPair top = read_noise(block.raw, input.calibration, block.top);
    const RealPair bottom =
        read_noise(block.raw + input.row_stride, input.calibration, block.bottom);
    const Noise noise = {top.right, top.left, bottom.left, bottom.right};
    return noise;
  }
#endif
  const Real none = PF_CONSTANT(Real, 0.0f);
  const Noise noise = {none, none, none, none};
  return noise;
}

/* A sensel that is neither missing nor saturated in any lane, with constant masks. */
PF_INLINE Sensel valid_sensel(Sensel sensel) {
  const Mask none = PF_CONSTANT(Mask, 0);
  sensel.missing = none;
  sensel.saturated = none;
  sensel.absent = none;
  return sensel;
}

#if !defined(PF_SENSELS) || defined(__cplusplus)
#define PF_PILLARS /* has programs with pillars */
PF_INLINE Mask is_invalid(Sensel sensel) { return sensel.missing || sensel.saturated; }
#endif

/* The linear readings of a block's sensels. */
PF_INLINE Pillar linear_block(Block block, Input input) {
  const SenselPair top = read_linear(block.raw, input.calibration, block.top);
  const SenselPair bottom =
      read_linear(block.raw + input.row_stride, input.calibration, block.bottom);
  const Pillar pillar = {top.right, top.left, bottom.left, bottom.right};
  return pillar;
}

/* The corrected sensels of a block with these linear readings. */
PF_INLINE Pillar corrected_block(Pillar linear, Block block, Input input) {
  const Calibration calibration = input.calibration;
  SenselPair top = {linear.s2, linear.s1};
  SenselPair bottom = {linear.s3, linear.s4};
#ifdef PF_LEAK
  if (PF_NAMED(leak)) {
    const Surroundings around = surroundings_of(block, input);
#ifdef PF_RING
    top = pair_in_ring(top, around, 0);
    bottom = pair_in_ring(bottom, around, 1);
#endif
    top = without_leak(top, around, 0, calibration.stages);
    bottom = without_leak(bottom, around, 1, calibration.stages);
  }
#endif
#ifdef PF_MEMORY
  if (PF_NAMED(memory)) {
    const Pillar before = {top.right, top.left, bottom.left, bottom.right};
    const Pillar recalled = recall_block(before, calibration, block);
    top.right = recalled.s1;
    top.left = recalled.s2;
    bottom.left = recalled.s3;
    bottom.right = recalled.s4;
  }
#endif
  top = finish_sensels(top, calibration, block.top);
  bottom = finish_sensels(bottom, calibration, block.bottom);
  const Pillar pillar = {top.right, top.left, bottom.left, bottom.right};
  return pillar;
}

#ifdef PF_SENSELS

#define PF_STORE_ROW(store, value, plane) store(left.value, right.value, (plane) + index, sensels)

/* Writes the results of one row of sensels, the first of them at `index`. */
PF_INLINE void store_sensels(SenselSolution left, SenselSolution right, Output output, size_t index,
                             Lanes sensels) {
  PF_STORE_ROW(store_sensel_plane, normal, (global float*)output.planes);
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    PF_STORE_ROW(store_sensel_plane, deviation,
                 (global float*)(output.planes + output.plane_bytes));
  }
#endif
  PF_STORE_ROW(store_sensel_status, status, output.status);
}
#undef PF_STORE_ROW

/* Solves a block of sensels without pillars, and writes those that exist. */
PF_INLINE void write_sensels(Block block, Input input, Output output) {
  const Stages stages = input.calibration.stages;
  const Pillar sensels = corrected_block(linear_block(block, input), block, input);
  const Noise noise = noise_of(block, input);
  const SenselSolution s1 = solve_sensel(sensels.s1, noise.n1, stages);
  const SenselSolution s2 = solve_sensel(sensels.s2, noise.n2, stages);
  const SenselSolution s3 = solve_sensel(sensels.s3, noise.n3, stages);
  const SenselSolution s4 = solve_sensel(sensels.s4, noise.n4, stages);
  const Lanes existing = {2 * block.lanes.first,
                          min(2 * block.lanes.end, output.cols - block.top.col)};
  const size_t index = (size_t)block.top.row * output.cols + block.top.col;
  store_sensels(s2, s1, output, index, existing);
  if (block.bottom.row < output.rows) {
    store_sensels(s3, s4, output, index + output.cols, existing);
  }
#ifdef PF_BASELINE
  const Bits touched = s1.status | s2.status | s3.status | s4.status;
  if (PF_NAMED(follow_baseline)) {
    store_status(touched, output.touched + block.index, block.lanes);
  }
#endif
}

#endif

#ifdef PF_PILLARS

PF_INLINE Solution solve_corrected(Pillar pillar, Block block, Input input) {
  return solve_pillar(pillar, noise_of(block, input), input.calibration.stages);
}

/* Solves a block. Most blocks have no missing and no saturated sensel; constant false masks let the
 * compiler drop half of the code for them. In C++ they are told apart after the corrections: of two
 * copies of these g++ makes slower code. */
PF_INLINE Solution solve_block(Block block, Input input) {
#ifdef __cplusplus
#define PF_CORRECTED(pillar) (pillar)
  const Pillar pillar = corrected_block(linear_block(block, input), block, input);
#else
#define PF_CORRECTED(pillar) corrected_block(pillar, block, input)
  const Pillar pillar = linear_block(block, input);
#endif
#if !defined(PF_SCALAR) && \
    (defined(PF_MASK) || defined(PF_SATURATION) || defined(PF_RANGE) || defined(PF_WIRES))
  const Mask invalid = is_invalid(pillar.s1) || is_invalid(pillar.s2) || is_invalid(pillar.s3) ||
                       is_invalid(pillar.s4);
  if (!any_lane(invalid)) {
    const Pillar valid = {valid_sensel(pillar.s1), valid_sensel(pillar.s2), valid_sensel(pillar.s3),
                          valid_sensel(pillar.s4)};
    return solve_corrected(PF_CORRECTED(valid), block, input);
  }
#endif
  return solve_corrected(PF_CORRECTED(pillar), block, input);
#undef PF_CORRECTED
}

#define PF_STORE(name, unit, value)                                   \
  store_plane(solution.value, (global float*)(plane) + index, lanes); \
  plane += output.plane_bytes;

/* Writes what is derived from the forces of `lanes`, lane 0 at pillar `index`. */
PF_INLINE void store_derived(Solution solution, Output output, size_t index, Lanes lanes) {
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  global uchar* plane = output.planes + 3 * output.plane_bytes;
#endif
#ifdef PF_ANGLES
  if (PF_NAMED(angles)) {
    PF_ANGLE_PLANES(PF_STORE)
  }
#endif
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    PF_UNCERTAINTY_PLANES(PF_STORE)
  }
#endif
}

/* Writes the results of `lanes`. */
PF_INLINE void store_lanes(Solution solution, Output output, size_t index, Lanes lanes) {
  global uchar* plane = output.forces;
  PF_FORCE_PLANES(PF_STORE)
  store_derived(solution, output, index, lanes);
  store_status(solution.status, output.status + index, lanes);
}
#undef PF_STORE

/* Writes the results of a block; tests once for all planes whether the block is whole. */
PF_INLINE void store_solution(Solution solution, Output output, size_t index, Lanes lanes) {
  const Lanes whole = {0, PF_LANES};
  if (are_all(lanes)) {
    store_lanes(solution, output, index, whole);
  } else {
    store_lanes(solution, output, index, lanes);
  }
}

#endif

/* Solves a block, and writes its results. */
PF_INLINE void write_block(Block block, Input input, Output output) {
#ifdef PF_SENSELS
  if (PF_NAMED(sensel_force)) {
    write_sensels(block, input, output);
    return;
  }
#endif
#ifdef PF_PILLARS
  store_solution(solve_block(block, input), output, block.index, block.lanes);
#endif
}

/* True if a block is idle and its stored results are already those of an idle block; updates its
 * flag. */
PF_INLINE bool may_skip(Row row, uint at, size_t sensel) {
#ifdef PF_SKIP_IDLE
  const uchar before = row.idle[at];
  const bool idle = block_is_idle(row, at, sensel);
  const uchar now = idle ? (before != 0 ? PF_IDLE : PF_NEWLY_IDLE) : 0;
  if (now != before) row.idle[at] = now;
  return idle && before != 0;
#else
  prefetch_readings(row, sensel, false);
  return false;
#endif
}

/* True if the ring shows eight blocks from `at` on as idle, and they were before. */
PF_INLINE bool may_skip_eight(Row row, uint at) {
#if defined(PF_SKIP_IDLE) && defined(PF_RING)
  return PF_NAMED(leak) && at + 8 <= row.blocks &&
         eight_flags(row.idle_now + at) == PF_EIGHT_IDLE &&
         eight_flags(row.idle + at) == PF_EIGHT_IDLE;
#else
  return false;
#endif
}

/* First of this work-item's blocks from `at` on that must be solved. */
PF_INLINE uint next_active(Row row, uint at) {
  const uint step = (uint)get_global_size(0);
  while (at < row.blocks) {
    if (step == 1 && may_skip_eight(row, at)) {
      at += 8;
      continue;
    }
    if (!may_skip(row, at, 2 * col_of_block(row, at))) break;
    at += step;
  }
  return at;
}

/* Lanes of the block at `col` that no other block of its row writes. `place` is its aligned
 * beginning, counted from `skew` pillars before the row. */
PF_INLINE Lanes own_lanes(uint place, uint skew, uint col, uint cols) {
  const uint first = max(place, skew) - skew;
  const uint end = min(place + PF_LANES - skew, cols);
  const Lanes lanes = {first - col, end - col};
  return lanes;
}

/* Solves this work-item's blocks of a pillar row. */
PF_INLINE void solve_row(Input input, Output output, uint at_row) {
  const uint pillar_cols = input.cols;
  const size_t first_index = (size_t)at_row * pillar_cols;
  const Row row = row_of(input, output.idle, at_row);
  size_t row_ahead = 2 * at_row + 2;
#ifdef PF_RING
  if (PF_NAMED(leak)) row_ahead = 2 * at_row + 4; /* the next one that fills the ring */
#endif
  const uint step = (uint)get_global_size(0);
  for (uint at = next_active(row, (uint)get_global_id(0)); at < row.blocks;
       at = next_active(row, at + step)) {
    const uint col = col_of_block(row, at);
    const Place top = {2 * at_row, 2 * col};
    const Place bottom = {2 * at_row + 1, 2 * col};
    prefetch_planes(input.calibration, row_ahead * input.calibration.stride + 2 * col);
    Lanes lanes = {0, PF_LANES};
#if defined(PF_STREAM) || defined(PF_MEMORY)
    if (PF_NAMED(memory)) lanes = own_lanes(at * PF_LANES, row.skew, col, pillar_cols);
#endif
    Block block;
    block.raw = row.raw + 2 * col;
    block.top = top;
    block.bottom = bottom;
    block.index = first_index + col;
    block.lanes = lanes;
#ifdef PF_MEMORY
    block.at = at;
    block.blocks = blocks_of_row(pillar_cols);
    if (PF_NAMED(memory)) prefetch_states(input.calibration, block);
#endif
    write_block(block, input, output);
  }
}

/* Solves a frame. A work-item solves every get_global_size(0)-th block of PF_LANES pillars in its
 * band of rows.
 *
 * raw          readings, layout.row_stride apart from one row of sensels to the next
 * calibration  planes, or null
 * results      planes of forces, and of angles and uncertainty if named, then the status bytes and
 *              the idle flags [rows, blocks_of_row(cols)], zero at first */
kernel void solve_frame(global const PF_SENSEL* restrict raw,
                        global const uchar* restrict calibration, global uchar* restrict results,
                        Layout layout, constant PlanNumbers* restrict numbers) {
  const Band band = band_of_rows((uint)layout.rows);
  Input input;
  input.raw = raw;
  input.row_stride = layout.row_stride;
  input.calibration = calibration_of(calibration, results, layout, numbers);
  input.rows = (uint)layout.rows;
  input.cols = (uint)layout.cols;
  global uchar* forces = results;
#ifdef PF_PILLAR_LEAK
  if (PF_NAMED(pillar_leak)) forces = results + layout.forces;
#endif
  const Output output = {forces,
                         results,
                         layout.result_bytes,
                         results + layout.status,
                         results + layout.idle,
#ifdef PF_SENSELS
                         results + layout.touched,
                         (uint)layout.sensel_rows,
                         (uint)layout.sensel_cols
#endif
  };
#ifdef PF_RING
  input.ring = ring_of((global float*)(results + layout.ring), input.cols);
#endif
  for (uint row = band.first; row < band.end; ++row) {
#ifdef PF_RING
    if (PF_NAMED(leak)) fill_ring(&input, output.idle, row, row == band.first);
#endif
    solve_row(input, output, row);
  }
}
