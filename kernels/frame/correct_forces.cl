/* Corrections of forces by those of the pillars around, after solve_frame: the leak between pillars
 * (stage PF_PILLAR_LEAK) and off-centre pressure (stage PF_LEAN). Only loaded pillars change. */
#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* Values of PF_LANES pillars of a row from column `col` on; zero outside. */
PF_INLINE Real load_pillars(global const float* row, int col, uint cols) {
#if PF_LANES == 1
  return col >= 0 && (uint)col < cols ? row[col] : 0.0f;
#else
  if (col >= 0 && (uint)col + PF_LANES <= cols) return PF_LOAD_WHOLE(float, row + col);
  float padded[PF_LANES];
  for (int i = 0; i < PF_LANES; ++i) {
    const int at = col + i;
    padded[i] = at >= 0 && (uint)at < cols ? row[at] : 0.0f;
  }
  return PF_VLOAD(0, padded);
#endif
}

/* Values of the pillars `down` rows below, above if negative, and from column `col` on; zero
 * outside. */
PF_INLINE Real load_near(global const float* plane, Layout layout, uint row, int down, int col) {
  const uint at = row + (uint)down;
  if (at >= (uint)layout.rows) return (Real)(0.0f);
  return load_pillars(plane + (size_t)at * layout.cols, col, (uint)layout.cols);
}

PF_INLINE Mask is_loaded(global const uchar* status, Layout layout, uint row, uint col) {
  const Bits bits = load_status(status + (size_t)row * layout.cols, (int)col, (uint)layout.cols);
  return mask_of(bits & PF_BITS(PF_STATUS_PRESSED));
}

#endif

#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* A block of a pillar row, as in solve_frame, and the lanes that it alone writes. */
typedef struct {
  uint col;
  Lanes lanes;
} OwnBlock;

PF_INLINE uint skew_of(uint row, uint cols) { return (uint)((size_t)row * cols % PF_LANES); }

PF_INLINE OwnBlock own_block(uint at, uint skew, uint cols) {
  OwnBlock block;
  block.col = min(max(at * PF_LANES, skew) - skew, cols - PF_LANES);
  block.lanes = own_lanes(at * PF_LANES, skew, block.col, cols);
  return block;
}

/* Idle flag of a block; zero where none are kept. */
PF_INLINE uchar idle_flag(global const uchar* results, Layout layout, uint row, uint at) {
#ifdef PF_SKIP_IDLE
  return results[layout.idle + (size_t)row * blocks_of_row((uint)layout.cols) + at];
#else
  return 0;
#endif
}

#if defined(PF_SKIP_IDLE) && PF_LANES > 1
typedef struct __attribute__((packed)) {
  ulong value;
} packed_flags;
#endif

/* Number of idle blocks from `at` on that a pass may skip together: 8 or none. */
PF_INLINE uint idle_run(global const uchar* results, Layout layout, uint row, uint at) {
#if defined(PF_SKIP_IDLE) && PF_LANES > 1
  const uint blocks = blocks_of_row((uint)layout.cols);
  if (at + 8 > blocks) return 0;
  global const uchar* const flags = results + layout.idle + (size_t)row * blocks + at;
  return ((global const packed_flags*)flags)->value == PF_IDLE * 0x0101010101010101ul ? 8 : 0;
#else
  return 0;
#endif
}

#endif

#ifdef PF_PILLAR_LEAK

/* A component of the force without the leak of the pillars around. */
PF_INLINE Real unleaked(global const float* plane, Layout layout, uint row, int col) {
  const Real own = load_near(plane, layout, row, 0, col);
  const Real edges =
      (load_near(plane, layout, row, 0, col - 1) + load_near(plane, layout, row, 0, col + 1)) +
      (load_near(plane, layout, row, -1, col) + load_near(plane, layout, row, 1, col));
  const Real corners =
      (load_near(plane, layout, row, -1, col - 1) + load_near(plane, layout, row, -1, col + 1)) +
      (load_near(plane, layout, row, 1, col - 1) + load_near(plane, layout, row, 1, col + 1));
  return pillar_without_leak(own, edges, corners, (Real)(PF_PILLAR_LEAK_SELF),
                             (Real)(PF_PILLAR_LEAK_EDGE), (Real)(PF_PILLAR_LEAK_CORNER));
}

/* Forces as solve_frame left them in the scratch memory, to the planes of the result. A work-item
 * corrects blocks as in solve_frame. */
kernel void remove_pillar_leak(global const PF_SENSEL* restrict raw,
                               global const uchar* restrict calibration,
                               global uchar* restrict results, Layout layout) {
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  for (uint row = band.first; row < band.end; ++row) {
    global const uchar* const changed = changed_in_row(results, layout, row);
    if (!changed) continue;
    const uint skew = skew_of(row, cols);
    for (uint at_block = (uint)get_global_id(0); at_block * PF_LANES < skew + cols;
         at_block += step) {
      const uint run = idle_run(results, layout, row, at_block);
      if (run != 0) {
        at_block += run - 1;
        continue;
      }
      if (!is_changed(changed, at_block)) continue;
      if (idle_flag(results, layout, row, at_block) == PF_IDLE) continue;
      const OwnBlock block = own_block(at_block, skew, cols);
      const uint col = block.col;
      const Mask loaded = is_loaded(results + layout.status, layout, row, col);
      for (uint plane = 0; plane < 3; ++plane) {
        global const float* const solved =
            (global const float*)(results + layout.forces + plane * layout.result_bytes);
        global float* const to = (global float*)(results + plane * layout.result_bytes);
        const Real force = loaded ? unleaked(solved, layout, row, (int)col) : (Real)(0.0f);
        store_plane(force, to + (size_t)row * cols + col, block.lanes);
      }
    }
  }
}

#endif

#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* Results of PF_LANES pillars; zero where the plan does not have them. */
PF_INLINE Solution load_solution(global const uchar* results, Layout layout, uint row, uint col) {
  Solution solution;
  global const uchar* plane = results;
#define PF_LOAD(name, unit, value)                                                  \
  solution.value = load_near((global const float*)plane, layout, row, 0, (int)col); \
  plane += layout.result_bytes;
  PF_FORCE_PLANES(PF_LOAD)
#ifdef PF_ANGLES
  PF_ANGLE_PLANES(PF_LOAD)
#endif
#ifdef PF_UNCERTAINTY
  PF_UNCERTAINTY_PLANES(PF_LOAD)
#endif
#undef PF_LOAD
  solution.status =
      load_status(results + layout.status + (size_t)row * layout.cols, (int)col, (uint)layout.cols);
  return solution;
}

/* Writes all but the normal forces, which other work-items read. */
PF_INLINE void store_corrected(Solution solution, Output output, size_t index, Lanes lanes) {
  store_plane(solution.force.shear_x, (global float*)output.planes + index, lanes);
  store_plane(solution.force.shear_y, (global float*)(output.planes + output.plane_bytes) + index,
              lanes);
  store_derived(solution, output, index, lanes);
#ifdef PF_LEAN
  store_status(solution.status, output.status + index, lanes);
#endif
}

/* Subtracts the lean of the pressure from the shear, and derives the other results from the
 * corrected forces. A work-item corrects blocks as in solve_frame. */
kernel void correct_forces(global const PF_SENSEL* restrict raw,
                           global const uchar* restrict calibration, global uchar* restrict results,
                           Layout layout) {
  const Calibration planes = calibration_of(calibration, results, layout);
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  global const float* const normal = (global const float*)(results + 2 * layout.result_bytes);
  const Output output = {results, results, layout.result_bytes, results + layout.status,
                         results + layout.idle};
  for (uint row = band.first; row < band.end; ++row) {
    global const uchar* const changed = changed_in_row(results, layout, row);
    if (!changed) continue;
    const uint skew = skew_of(row, cols);
    for (uint at_block = (uint)get_global_id(0); at_block * PF_LANES < skew + cols;
         at_block += step) {
      const uint run = idle_run(results, layout, row, at_block);
      if (run != 0) {
        at_block += run - 1;
        continue;
      }
      if (!is_changed(changed, at_block)) continue;
      if (idle_flag(results, layout, row, at_block) != 0) continue;
      const OwnBlock block = own_block(at_block, skew, cols);
      const uint col = block.col;
      if (!any_lane(is_loaded(results + layout.status, layout, row, col))) continue;
      const int at = (int)col;
      const Real own = load_near(normal, layout, row, 0, at);
      const Lean x = lean_between(
          load_near(normal, layout, row, 0, at - 2), load_near(normal, layout, row, 0, at - 1), own,
          load_near(normal, layout, row, 0, at + 1), load_near(normal, layout, row, 0, at + 2));
      const Lean y = lean_between(
          load_near(normal, layout, row, 2, at), load_near(normal, layout, row, 1, at), own,
          load_near(normal, layout, row, -1, at), load_near(normal, layout, row, -2, at));
      const Solution solution =
          correct_solution(load_solution(results, layout, row, col), x, y, planes.stages);
      store_corrected(solution, output, (size_t)row * cols + col, block.lanes);
    }
  }
}

#endif
