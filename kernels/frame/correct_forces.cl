/* Corrections of forces by those of the pillars around, after solve_frame: the leak between pillars
 * (stage PF_PILLAR_LEAK) and off-centre pressure (stage PF_LEAN). Only loaded pillars change. */
#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* Values of PF_LANES pillars of a row from column `col` on; zero outside. */
PF_INLINE Real load_pillars(global const float* row, int col, uint cols) {
#ifdef PF_SCALAR
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
  if (at >= (uint)layout.rows) return PF_CONSTANT(Real, 0.0f);
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

/* A row of blocks as in solve_frame. */
typedef struct {
  uint cols;
  uint skew;
  uint blocks;
  global const uchar* idle; /* idle flags; null where none are kept */
} OwnRow;

PF_INLINE OwnRow own_row(global const uchar* results, Layout layout, uint at) {
  OwnRow row;
  row.cols = (uint)layout.cols;
  row.skew = (uint)((size_t)at * row.cols % PF_LANES);
  row.blocks = (row.skew + row.cols + PF_LANES - 1) / PF_LANES;
#ifdef PF_SKIP_IDLE
  row.idle = results + layout.idle + (size_t)at * blocks_of_row(row.cols);
#else
  row.idle = 0;
#endif
  return row;
}

PF_INLINE OwnBlock own_block(OwnRow row, uint at) {
  OwnBlock block;
  block.col = min(max(at * PF_LANES, row.skew) - row.skew, row.cols - PF_LANES);
  block.lanes = own_lanes(at * PF_LANES, row.skew, block.col, row.cols);
  return block;
}

#ifdef PF_SKIP_IDLE
typedef struct __attribute__((packed)) {
  ulong value;
} packed_flags;
#endif

/* First of this work-item's blocks from `at` on that is active, or has the idle flag `also`. */
PF_INLINE uint next_correctable(OwnRow row, uint at, uchar also) {
#ifdef PF_SKIP_IDLE
  const uint step = (uint)get_global_size(0);
  while (at < row.blocks) {
    const ulong all_idle = PF_IDLE * 0x0101010101010101ul;
    if (step == 1 && at + 8 <= row.blocks &&
        ((global const packed_flags*)(row.idle + at))->value == all_idle) {
      at += 8;
      continue;
    }
    const uchar flag = row.idle[at];
    if (flag == 0 || flag == also) break;
    at += step;
  }
#endif
  return at;
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
  return pillar_without_leak(own, edges, corners, PF_VALUE(Real, pillar_leak_self),
                             PF_VALUE(Real, pillar_leak_edge), PF_VALUE(Real, pillar_leak_corner));
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
    const OwnRow own = own_row(results, layout, row);
    for (uint at = next_correctable(own, (uint)get_global_id(0), PF_NEWLY_IDLE); at < own.blocks;
         at = next_correctable(own, at + step, PF_NEWLY_IDLE)) {
      const OwnBlock block = own_block(own, at);
      const uint col = block.col;
      const Mask loaded = is_loaded(results + layout.status, layout, row, col);
      for (uint plane = 0; plane < 3; ++plane) {
        global const float* const solved =
            (global const float*)(results + layout.forces + plane * layout.result_bytes);
        global float* const to = (global float*)(results + plane * layout.result_bytes);
        const Real force =
            loaded ? unleaked(solved, layout, row, (int)col) : PF_CONSTANT(Real, 0.0f);
        store_plane(force, to + (size_t)row * cols + col, block.lanes);
      }
    }
  }
}

#endif

#ifdef PF_LEAN

PF_INLINE Lean lean_along(global const float* normal, Layout layout, uint row, int col, int down,
                          int right) {
  return lean_between(load_near(normal, layout, row, -2 * down, col - 2 * right),
                      load_near(normal, layout, row, -down, col - right),
                      load_near(normal, layout, row, 0, col),
                      load_near(normal, layout, row, down, col + right),
                      load_near(normal, layout, row, 2 * down, col + 2 * right));
}

/* The plane of the scratch memory with values or variances of the ratios of an axis. */
enum { kRatioX, kVarianceX, kRatioY, kVarianceY };
PF_INLINE global float* ratio_plane(global uchar* results, Layout layout, uint plane) {
  return (global float*)(results + layout.ratios + plane * layout.result_bytes);
}

/* Ratios of shear to normal force of the loaded pillars, by their own readings and lean, to the
 * scratch memory. A work-item finds blocks as in solve_frame. */
kernel void find_shear_ratios(global const PF_SENSEL* restrict raw,
                              global const uchar* restrict calibration,
                              global uchar* restrict results, Layout layout) {
  const Calibration planes = calibration_of(calibration, results, layout);
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  global const float* const plane = (global const float*)results;
  const size_t plane_floats = layout.result_bytes / sizeof(float);
  for (uint row = band.first; row < band.end; ++row) {
    const OwnRow own = own_row(results, layout, row);
    for (uint at = next_correctable(own, (uint)get_global_id(0), 0); at < own.blocks;
         at = next_correctable(own, at + step, 0)) {
      const OwnBlock block = own_block(own, at);
      const int col = (int)block.col;
      const Bits status = load_status(results + layout.status + (size_t)row * cols, col, cols);
      if (!any_lane(mask_of(status & PF_BITS(PF_STATUS_PRESSED)))) continue;
      global const float* const normal = plane + 2 * plane_floats;
      const Force force = {load_near(plane, layout, row, 0, col),
                           load_near(plane + plane_floats, layout, row, 0, col),
                           load_near(normal, layout, row, 0, col)};
      const ShearRatios ratios =
          shear_ratios(force, status, lean_along(normal, layout, row, col, 0, 1),
                       lean_along(normal, layout, row, col, -1, 0), planes.stages);
      const size_t index = (size_t)row * cols + block.col;
      store_plane(ratios.x.value, ratio_plane(results, layout, kRatioX) + index, block.lanes);
      store_plane(ratios.x.variance, ratio_plane(results, layout, kVarianceX) + index, block.lanes);
      store_plane(ratios.y.value, ratio_plane(results, layout, kRatioY) + index, block.lanes);
      store_plane(ratios.y.variance, ratio_plane(results, layout, kVarianceY) + index, block.lanes);
    }
  }
}

/* Loads the shear ratio of a pillar along one axis. `first`: its plane. Undefined for unloaded
 * pillars. */
PF_INLINE ShearRatio load_ratio(global uchar* results, Layout layout, uint first, uint row,
                                int down, int col) {
  ShearRatio ratio;
  ratio.value = load_near(ratio_plane(results, layout, first), layout, row, down, col);
  ratio.variance = load_near(ratio_plane(results, layout, first + 1), layout, row, down, col);
  return ratio;
}

/* The part of the two pillars that are `down` and `right`, and as far on the other side. */
PF_INLINE RatioSum opposite_parts(global uchar* results, Layout layout, uint first, ShearRatio own,
                                  uint row, int col, int down, int right) {
  global const float* const normal = (global const float*)(results + 2 * layout.result_bytes);
  const Real distance = PF_CONSTANT(Real, (float)(down * down + right * right));
  const RatioSum after = ratio_part(own, load_ratio(results, layout, first, row, down, col + right),
                                    load_near(normal, layout, row, down, col + right), distance);
  const RatioSum before =
      ratio_part(own, load_ratio(results, layout, first, row, -down, col - right),
                 load_near(normal, layout, row, -down, col - right), distance);
  return add_ratios(before, after);
}

/* The mean ratio of 3 x 3 pillars along an axis. */
PF_INLINE ShearRatio mean_of_ratios(global uchar* results, Layout layout, uint first, uint row,
                                    int col) {
  const ShearRatio own = load_ratio(results, layout, first, row, 0, col);
  const RatioSum edges = add_ratios(opposite_parts(results, layout, first, own, row, col, 0, 1),
                                    opposite_parts(results, layout, first, own, row, col, 1, 0));
  const RatioSum corners = add_ratios(opposite_parts(results, layout, first, own, row, col, 1, 1),
                                      opposite_parts(results, layout, first, own, row, col, 1, -1));
  return mean_ratio(own, add_ratios(edges, corners));
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
  if (PF_NAMED(angles)) {
    PF_ANGLE_PLANES(PF_LOAD)
  }
#endif
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    PF_UNCERTAINTY_PLANES(PF_LOAD)
  }
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
  if (PF_NAMED(lean)) store_status(solution.status, output.status + index, lanes);
#endif
}

/* Takes the shear from the mean ratios, and derives the other results from the corrected forces. A
 * work-item corrects blocks as in solve_frame. */
kernel void correct_forces(global const PF_SENSEL* restrict raw,
                           global const uchar* restrict calibration, global uchar* restrict results,
                           Layout layout) {
  const Calibration planes = calibration_of(calibration, results, layout);
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  const Output output = {results, results, layout.result_bytes, results + layout.status,
                         results + layout.idle};
  for (uint row = band.first; row < band.end; ++row) {
    const OwnRow own = own_row(results, layout, row);
    for (uint at = next_correctable(own, (uint)get_global_id(0), 0); at < own.blocks;
         at = next_correctable(own, at + step, 0)) {
      const OwnBlock block = own_block(own, at);
      const uint col = block.col;
      if (!any_lane(is_loaded(results + layout.status, layout, row, col))) continue;
      const Real none = PF_CONSTANT(Real, 0.0f);
      ShearRatios ratios = {{none, none}, {none, none}};
#ifdef PF_LEAN
      if (PF_NAMED(lean)) {
        ratios.x = mean_of_ratios(results, layout, kRatioX, row, (int)col);
        ratios.y = mean_of_ratios(results, layout, kRatioY, row, (int)col);
      }
#endif
      const Solution solution =
          correct_solution(load_solution(results, layout, row, col), ratios, planes.stages);
      store_corrected(solution, output, (size_t)row * cols + col, block.lanes);
    }
  }
}

#endif
