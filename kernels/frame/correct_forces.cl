/* Corrections of forces by those of the pillars around, after solve_frame: the leak between pillars
 * (stage PF_PILLAR_LEAK) and off-centre pressure (stage PF_LEAN). Only loaded pillars change. */
#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* Values of PF_LANES pillars. */
PF_INLINE Real load_own(global const float* place) {
#ifdef PF_SCALAR
  return *place;
#else
  return PF_LOAD_WHOLE(float, place);
#endif
}

PF_INLINE void store_own(Real value, global float* place) {
#ifdef PF_SCALAR
  *place = value;
#else
  PF_STORE_WHOLE(float, value, place);
#endif
}

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

PF_INLINE Bits status_at(global const uchar* results, Layout layout, size_t index) {
  return load_status(results + layout.status + index, 0, PF_LANES);
}

PF_INLINE Mask is_loaded(Bits status) { return mask_of(status & PF_BITS(PF_STATUS_PRESSED)); }

#endif

#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

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

/* The first column of a block, and the lanes that it alone writes. (PoCL would pass a structure of
 * both through memory.) */
PF_INLINE uint own_col(OwnRow row, uint at) {
  return min(max(at * PF_LANES, row.skew) - row.skew, row.cols - PF_LANES);
}
PF_INLINE Lanes lanes_of_block(OwnRow row, uint at) {
  return own_lanes(at * PF_LANES, row.skew, own_col(row, at), row.cols);
}

/* First of this work-item's blocks from `at` on that is active, or has the idle flag `also`. */
PF_INLINE uint next_correctable(OwnRow row, uint at, uchar also) {
#ifdef PF_SKIP_IDLE
  const uint step = (uint)get_global_size(0);
  while (at < row.blocks) {
    if (step == 1 && at + 8 <= row.blocks && eight_flags(row.idle + at) == PF_EIGHT_IDLE) {
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

/* As load_near(); all pillars beside the block exist if it lies `inside`. */
PF_INLINE Real load_beside(global const float* plane, Layout layout, uint row, int down, int col,
                           bool inside) {
  if (!inside) return load_near(plane, layout, row, down, col);
  return load_own(plane + (row + (size_t)down) * layout.cols + col);
}

/* A component of the force without the leak of the pillars around. */
PF_INLINE Real unleaked(global const float* plane, Layout layout, uint row, int col, bool inside,
                        Stages stages) {
#define PF_AT(down, right) load_beside(plane, layout, row, down, col + (right), inside)
  const Real edges = (PF_AT(0, -1) + PF_AT(0, 1)) + (PF_AT(-1, 0) + PF_AT(1, 0));
  const Real corners = (PF_AT(-1, -1) + PF_AT(-1, 1)) + (PF_AT(1, -1) + PF_AT(1, 1));
  return pillar_without_leak(PF_AT(0, 0), edges, corners, PF_VALUE(Real, pillar_leak_self),
                             PF_VALUE(Real, pillar_leak_edge), PF_VALUE(Real, pillar_leak_corner));
#undef PF_AT
}

/* Forces as solve_frame left them in the scratch memory, to the planes of the result. A work-item
 * corrects blocks as in solve_frame. */
kernel void remove_pillar_leak(global const PF_SENSEL* restrict raw,
                               global const uchar* restrict calibration,
                               global uchar* restrict results, Layout layout,
                               constant PlanNumbers* restrict numbers) {
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  for (uint row = band.first; row < band.end; ++row) {
    const OwnRow own = own_row(results, layout, row);
    for (uint at = next_correctable(own, (uint)get_global_id(0), PF_NEWLY_IDLE); at < own.blocks;
         at = next_correctable(own, at + step, PF_NEWLY_IDLE)) {
      const uint col = own_col(own, at);
      const Lanes lanes = lanes_of_block(own, at);
      const size_t index = (size_t)row * cols + col;
      const Mask loaded = is_loaded(status_at(results, layout, index));
      const bool inside =
          row > 0 && row + 1 < (uint)layout.rows && col > 0 && col + PF_LANES < cols;
      for (uint plane = 0; plane < 3; ++plane) {
        global const float* const solved =
            (global const float*)(results + layout.forces + plane * layout.result_bytes);
        PF_PREFETCH_SPAN(solved + index + 2 * cols, PF_LANES, 3);
        global float* const to = (global float*)(results + plane * layout.result_bytes);
        const Real all = inside ? unleaked(solved, layout, row, (int)col, true, numbers)
                                : unleaked(solved, layout, row, (int)col, false, numbers);
        store_plane(loaded ? all : PF_CONSTANT(Real, 0.0f), to + index, lanes);
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

/* Values of each axis in the scratch memory. */
enum { kRatio, kVariance, kBeside, kDiagonal, kRatioValues };

/* Rows of scratch memory: with one lane all rows of pillars. With several lanes a work-item finds
 * the ratios of its rows just before it needs them; each band has a ring of three, and its first
 * and its last row, which other bands read. */
enum { kRatioRing = 3, kRatioRows = 5 };

/* The ratios of a row of this band, or of the row before or after it. */
PF_INLINE global float* ratios_of_row(global uchar* results, Layout layout, Band band, uint row) {
  size_t place = row;
#ifndef PF_SCALAR
  if (row < band.first) band = band_of(band.number - 1, (uint)layout.rows);
  if (row >= band.end) band = band_of(band.number + 1, (uint)layout.rows);
  place = row % kRatioRing;
  if (row + 1 == band.end) place = kRatioRing + 1;
  if (row == band.first) place = kRatioRing;
  place += (size_t)kRatioRows * band.number;
#endif
  return (global float*)(results + layout.ratios) + place * 2 * kRatioValues * layout.cols;
}

PF_INLINE void store_ratio(WeightedRatio ratio, global float* to, size_t cols) {
  store_own(ratio.own.value, to + kRatio * cols);
  store_own(ratio.own.variance, to + kVariance * cols);
  store_own(ratio.beside, to + kBeside * cols);
  store_own(ratio.diagonal, to + kDiagonal * cols);
}

/* Ratios of shear to normal force of a row's loaded pillars, by their own readings and lean, to the
 * scratch memory. */
PF_INLINE void find_ratios_of_row(global uchar* results, Calibration planes, Layout layout,
                                  Band band, uint row) {
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  global const float* const shear_x = (global const float*)results;
  const size_t plane = layout.result_bytes / sizeof(float);
  global const float* const shear_y = shear_x + plane;
  global const float* const normal = shear_y + plane;
  global float* const to = ratios_of_row(results, layout, band, row);
  const OwnRow own = own_row(results, layout, row);
  for (uint at = next_correctable(own, (uint)get_global_id(0), 0); at < own.blocks;
       at = next_correctable(own, at + step, 0)) {
    const uint col = own_col(own, at);
    const size_t index = (size_t)row * cols + col;
    const Bits status = status_at(results, layout, index);
    if (!any_lane(is_loaded(status))) continue;
    const Force force = {load_own(shear_x + index), load_own(shear_y + index),
                         load_own(normal + index)};
    const WeightedRatios ratios =
        shear_ratios(force, status, lean_along(normal, layout, row, (int)col, 0, 1),
                     lean_along(normal, layout, row, (int)col, -1, 0), planes.stages);
    store_ratio(ratios.x, to + col, cols);
    store_ratio(ratios.y, to + kRatioValues * cols + col, cols);
  }
}

/* The ratios that other work-items read, or with one lane all. A work-item finds blocks as in
 * solve_frame. */
kernel void find_shear_ratios(global const PF_SENSEL* restrict raw,
                              global const uchar* restrict calibration,
                              global uchar* restrict results, Layout layout,
                              constant PlanNumbers* restrict numbers) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  const Band band = band_of_rows((uint)layout.rows);
#ifdef PF_SCALAR
  const uint step = 1;
#else
  const uint step = max(band.end - band.first, 2u) - 1;
#endif
  for (uint row = band.first; row < band.end; row += step) {
    find_ratios_of_row(results, planes, layout, band, row);
  }
}

/* True where a pillar around PF_LANES pillars has a load: rows from above, columns from the left.
 * Scratch memory holds anything beside the others. */
typedef struct {
  Mask at[3][3];
} LoadedAround;

PF_INLINE LoadedAround loaded_around(global const float* normal, Layout layout, uint row, int col) {
  LoadedAround loaded;
  PF_UNROLL
  for (int down = -1; down < 2; ++down) {
    PF_UNROLL
    for (int right = -1; right < 2; ++right) {
      loaded.at[down + 1][right + 1] =
          load_near(normal, layout, row, down, col + right) > PF_REAL(0.0);
    }
  }
  return loaded;
}

/* The parts of a pillar and of the one as far on the other side, with the ratios of an axis at
 * `before` and `after`. `weights`: kBeside or kDiagonal. */
PF_INLINE RatioSum opposite_parts(Real own, global const float* before, Mask loaded_before,
                                  global const float* after, Mask loaded_after, size_t weights) {
  const Real none = PF_REAL(0.0);
  const Real weight_before = loaded_before ? load_own(before + weights) : none;
  const Real weight_after = loaded_after ? load_own(after + weights) : none;
  return add_ratios(ratio_part(own, load_own(before), weight_before),
                    ratio_part(own, load_own(after), weight_after));
}

/* The mean ratio of 3 x 3 pillars along an axis, whose ratios in the row of the pillars, above and
 * below are at these places. */
PF_INLINE ShearRatio mean_of_ratios(global const float* above, global const float* ratios,
                                    global const float* below, size_t cols, LoadedAround loaded) {
  const size_t beside = kBeside * cols;
  const size_t diagonal = kDiagonal * cols;
  const ShearRatio own = {load_own(ratios + kRatio * cols), load_own(ratios + kVariance * cols)};
  const Real value = own.value;
  const RatioSum edges = add_ratios(
      opposite_parts(value, ratios - 1, loaded.at[1][0], ratios + 1, loaded.at[1][2], beside),
      opposite_parts(value, above, loaded.at[0][1], below, loaded.at[2][1], beside));
  const RatioSum corners = add_ratios(
      opposite_parts(value, above - 1, loaded.at[0][0], below + 1, loaded.at[2][2], diagonal),
      opposite_parts(value, above + 1, loaded.at[0][2], below - 1, loaded.at[2][0], diagonal));
  return mean_ratio(own, add_ratios(edges, corners));
}

#endif

#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)

/* Results of PF_LANES pillars; zero where the plan does not have them. */
PF_INLINE Solution load_solution(global const uchar* results, Layout layout, size_t index) {
  Solution solution;
  global const uchar* plane = results;
#define PF_LOAD(name, unit, value)                               \
  solution.value = load_own((global const float*)plane + index); \
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
  solution.status = status_at(results, layout, index);
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
                           Layout layout, constant PlanNumbers* restrict numbers) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  const Band band = band_of_rows((uint)layout.rows);
  const uint cols = (uint)layout.cols;
  const uint step = (uint)get_global_size(0);
  const Output output = {results, results, layout.result_bytes, results + layout.status,
                         results + layout.idle};
  for (uint row = band.first; row < band.end; ++row) {
    const OwnRow own = own_row(results, layout, row);
#ifdef PF_LEAN
#ifndef PF_SCALAR
    if (PF_NAMED(lean) && row + 2 < band.end) {
      find_ratios_of_row(results, planes, layout, band, row + 1);
    }
#endif
    global const float* const ratios_here = ratios_of_row(results, layout, band, row);
    global const float* const ratios_above =
        row == 0 ? ratios_here : ratios_of_row(results, layout, band, row - 1);
    global const float* const ratios_below =
        row + 1 == (uint)layout.rows ? ratios_here : ratios_of_row(results, layout, band, row + 1);
#endif
    for (uint at = next_correctable(own, (uint)get_global_id(0), 0); at < own.blocks;
         at = next_correctable(own, at + step, 0)) {
      const uint col = own_col(own, at);
      const size_t index = (size_t)row * cols + col;
      Solution solution = load_solution(results, layout, index);
      if (!any_lane(is_loaded(solution.status))) continue;
      ShearRatios ratios = {{PF_REAL(0.0), PF_REAL(0.0)}, {PF_REAL(0.0), PF_REAL(0.0)}};
#ifdef PF_LEAN
      if (PF_NAMED(lean)) {
        const size_t plane = layout.result_bytes / sizeof(float);
        const LoadedAround loaded =
            loaded_around((global const float*)results + 2 * plane, layout, row, (int)col);
        const size_t y = kRatioValues * cols + col;
        ratios.x =
            mean_of_ratios(ratios_above + col, ratios_here + col, ratios_below + col, cols, loaded);
        ratios.y =
            mean_of_ratios(ratios_above + y, ratios_here + y, ratios_below + y, cols, loaded);
      }
#endif
      solution = correct_solution(solution, ratios, planes.stages);
      store_corrected(solution, output, index, lanes_of_block(own, at));
    }
  }
}

#endif
