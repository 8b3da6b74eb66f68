/* Finds how the wires of each tile act on its readings, before solve_frame reads them, and which
 * tiles are idle. Stage PF_WIRES, with PF_TILE_ROWS and
 * PF_TILE_COLS. Stage PF_WIRES_AFTER_TARE: the wires act on readings less the
 * tare, which is an offset behind them. */
#ifdef PF_WIRES

#define PF_TILE_PARTS ((PF_TILE_COLS + PF_WIRE_PARTS - 1) / PF_WIRE_PARTS * PF_WIRE_PARTS)

#ifdef PF_RANGE
#define PF_IN_RANGE(type, reading) (fabs(reading) <= PF_VALUE(type, largest))
#else
#define PF_IN_RANGE(type, reading) (PF_CONSTANT(type, 0.0f) == PF_CONSTANT(type, 0.0f))
#endif
/* Readings less their offset for the sums; missing sensels count as zero. */
#define PF_DEFINE_SUMMED(name, type)                                               \
  PF_INLINE type name(type reading, type offset, type good, Stages stages) {       \
    const type none = PF_CONSTANT(type, 0.0f);                                     \
    const type summed = good == PF_CONSTANT(type, 1.0f) ? reading - offset : none; \
    return PF_IN_RANGE(type, reading) ? summed : none;                             \
  }
PF_DEFINE_SUMMED(summed_reading, float)
#ifndef PF_SCALAR
PF_DEFINE_SUMMED(summed_readings, Real)
#endif

PF_INLINE WireModel wire_model(Stages stages) {
  const WireModel model = {PF_NUMBER(row_per_count), PF_NUMBER(column_per_count),
                           PF_NUMBER(idle_per_count)};
  return model;
}

/* Reads the sensels of a tile's row. */
PF_INLINE void read_tile_row(global const PF_SENSEL* raw, Calibration calibration, size_t offset,
                             uint cols, float* readings) {
  uint col = 0;
#ifdef PF_TARE
  global const float* const tares = PF_PLANE_OF(calibration, float, PF_TARE_PLANE) + offset;
#define PF_HAS_OFFSETS (PF_AFTER_TARE && PF_NAMED(tare))
#define PF_OFFSETS_AT(col) (PF_HAS_OFFSETS ? PF_LOAD_WHOLE(float, tares + (col)) : PF_REAL(0.0))
#define PF_OFFSET_AT(col) (PF_HAS_OFFSETS ? tares[col] : 0.0f)
#else
#define PF_OFFSETS_AT(col) PF_REAL(0.0)
#define PF_OFFSET_AT(col) 0.0f
#endif
#ifdef PF_MASK
  global const uchar* const good = PF_PLANE_OF(calibration, uchar, PF_MASK_PLANE) + offset;
#endif
#ifndef PF_SCALAR
  for (; col + PF_LANES <= cols; col += PF_LANES) {
    Real valid = PF_CONSTANT(Real, 1.0f);
#ifdef PF_MASK
    if (PF_NAMED(mask)) valid = PF_TO_REAL(PF_LOAD_WHOLE(uchar, good + col));
#endif
    const Real reading = PF_TO_REAL(PF_LOAD_WHOLE(PF_SENSEL, raw + col));
    PF_STORE_WIRES(summed_readings(reading, PF_OFFSETS_AT(col), valid, calibration.stages),
                   readings + col);
  }
#endif
  for (; col < cols; ++col) {
    float valid = 1.0f;
#ifdef PF_MASK
    if (PF_NAMED(mask)) valid = (float)good[col];
#endif
    readings[col] = summed_reading((float)raw[col], PF_OFFSET_AT(col), valid, calibration.stages);
  }
}

#ifdef PF_SCALAR

/* Work-items of a group share a tile: each sums rows, then finds columns. They exchange results in
 * the vectors of the frame, where `own` holds k until the end. */

/* The sensel of a tile in this row and column of it, for the sums. */
PF_INLINE float reading_in_tile(global const PF_SENSEL* raw, Calibration calibration, Layout layout,
                                Tile tile, uint row, uint col) {
  const size_t sensel_row = tile.row + row;
  const size_t sensel_col = tile.col + col;
  float reading;
  read_tile_row(raw + sensel_row * layout.row_stride + sensel_col, calibration,
                sensel_row * calibration.stride + sensel_col, 1, &reading);
  return reading;
}

/* As sums_of_row(). */
PF_INLINE RowSums sums_in_tile(global const PF_SENSEL* raw, Calibration calibration, Layout layout,
                               Tile tile, uint row, global const float* gains) {
  float loads[PF_WIRE_PARTS];
  float squares[PF_WIRE_PARTS];
  PF_UNROLL
  for (uint i = 0; i < PF_WIRE_PARTS; ++i) loads[i] = squares[i] = 0.0f;
  for (uint at = 0; at < tile.cols; at += PF_WIRE_PARTS) {
    PF_UNROLL
    for (uint i = 0; i < PF_WIRE_PARTS; ++i) {
      if (at + i >= tile.cols) continue;
      const float reading = reading_in_tile(raw, calibration, layout, tile, row, at + i);
      const float load = reading * gains[at + i];
      loads[i] = loads[i] + load;
      squares[i] = squares[i] + reading * load;
    }
  }
  const RowSums sums = {sum_of_parts(loads), sum_of_parts(squares)};
  return sums;
}

/* The loss of a column over all rows of a tile, as add_row() adds it. */
PF_INLINE float loss_in_tile(global const PF_SENSEL* raw, Calibration calibration, Layout layout,
                             Tile tile, uint col, global const float* rows,
                             global const float* driven, WireModel model) {
  float losses = 0.0f;
  for (uint row = 0; row < tile.rows; ++row) {
    const float reading = reading_in_tile(raw, calibration, layout, tile, row, col);
    losses = losses + losses_in_row(reading, rows[row], driven[row], model);
  }
  return losses;
}

/* Finds the wires of a tile with the other work-items of the group. */
PF_INLINE void sweep_tile(global const PF_SENSEL* raw, Calibration calibration, Layout layout,
                          Tile tile, global float* rows, global float* own, global float* gains) {
  const WireModel model = wire_model(calibration.stages);
  for (uint row = PF_TILE_ITEM; row < tile.rows; row += PF_TILE_ITEMS) {
    rows[row] = 1.0f;
    own[row] = 0.0f;
  }
  for (uint col = PF_TILE_ITEM; col < tile.cols; col += PF_TILE_ITEMS) gains[col] = 1.0f;
  for (uint sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (uint row = PF_TILE_ITEM; row < tile.rows; row += PF_TILE_ITEMS) {
      const RowSums sums = sums_in_tile(raw, calibration, layout, tile, row, gains);
      const RowWires before = {rows[row], own[row]};
      const RowWires after = wires_of_rows(sums.load, sums.square, before, model);
      rows[row] = after.row;
      own[row] = after.driven;
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
    for (uint col = PF_TILE_ITEM; col < tile.cols; col += PF_TILE_ITEMS) {
      gains[col] =
          gain_of_loss(loss_in_tile(raw, calibration, layout, tile, col, rows, own, model));
    }
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (uint row = PF_TILE_ITEM; row < tile.rows; row += PF_TILE_ITEMS)
    own[row] = own[row] * rows[row];
}

#else

#ifndef PF_MOST_TILE_ROWS
#define PF_MOST_TILE_ROWS PF_TILE_ROWS
#define PF_MOST_TILE_PARTS PF_TILE_PARTS
#endif

/* A tile's wires (RowWires, and the gains of its columns); rows and columns are padded. */
typedef struct {
  float row[PF_MOST_TILE_ROWS + PF_LANES];
  float driven[PF_MOST_TILE_ROWS + PF_LANES];
  float column[PF_MOST_TILE_PARTS];
} TileWires;

PF_INLINE void fill_floats(float* values, uint count, float value) {
  for (uint i = 0; i < count; ++i) values[i] = value;
}

/* Finds the wires of a tile: those of its rows, PF_LANES at a time, then the gains of its columns.
 */
PF_INLINE void sweep_tile(global const PF_SENSEL* raw, Calibration calibration, Layout layout,
                          Tile tile, global float* rows, global float* own, global float* gains) {
  if (tile.rows == 0) return;
  const WireModel model = wire_model(calibration.stages);
  TileWires found;
  float readings[PF_LANES * PF_MOST_TILE_PARTS];
  float losses[PF_MOST_TILE_PARTS];
  float loads[PF_LANES];
  float squares[PF_LANES];
  if (tile.cols < PF_TILE_PARTS) fill_floats(readings, PF_LANES * PF_TILE_PARTS, 0.0f);
  fill_floats(losses, PF_TILE_PARTS, 0.0f);
  fill_floats(loads, PF_LANES, 0.0f);
  fill_floats(squares, PF_LANES, 0.0f);
  fill_floats(found.column, PF_TILE_PARTS, 1.0f);
  fill_floats(found.row, PF_TILE_ROWS + PF_LANES, 1.0f);
  fill_floats(found.driven, PF_TILE_ROWS + PF_LANES, 0.0f);
  for (uint sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    for (uint first = 0; first < tile.rows; first += PF_LANES) {
      const uint count = min(tile.rows - first, (uint)PF_LANES);
      for (uint i = 0; i < count; ++i) {
        float* const of_row = readings + i * PF_TILE_PARTS;
        const size_t at = tile.row + first + i;
        read_tile_row(raw + at * layout.row_stride + tile.col, calibration,
                      at * calibration.stride + tile.col, tile.cols, of_row);
        const RowSums sums = sums_of_row(of_row, found.column, PF_TILE_PARTS);
        loads[i] = sums.load;
        squares[i] = sums.square;
      }
      const RowWires before = {PF_LOAD_WIRES(found.row + first),
                               PF_LOAD_WIRES(found.driven + first)};
      const RowWires after =
          wires_of_rows(PF_LOAD_WIRES(loads), PF_LOAD_WIRES(squares), before, model);
      PF_STORE_WIRES(after.row, found.row + first);
      PF_STORE_WIRES(after.driven, found.driven + first);
      for (uint i = 0; i < count; ++i) {
        add_row(readings + i * PF_TILE_PARTS, losses, PF_TILE_PARTS, found.row[first + i],
                found.driven[first + i], model);
      }
    }
    find_columns(losses, found.column, PF_TILE_PARTS);
  }
  for (uint i = 0; i < tile.rows; ++i) {
    rows[i] = found.row[i];
    own[i] = found.driven[i] * found.row[i];
  }
  for (uint col = 0; col < tile.cols; ++col) gains[col] = found.column[col];
}

#endif

/* A work-item, with one lane a group of PF_TILE_ITEMS, finds the wires of one tile. */
kernel void find_wires(global const PF_SENSEL* restrict raw,
                       global const uchar* restrict calibration, global uchar* restrict results,
                       Layout layout, constant PlanNumbers* restrict numbers) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  const WireVectors wires = planes.wires;
  const uint across = (uint)(get_global_id(0) / PF_TILE_ITEMS);
  const uint down = (uint)get_global_id(1);
  Tile tile;
  tile.row = down * PF_TILE_ROWS;
  tile.col = across * PF_TILE_COLS;
  tile.rows = min((uint)PF_TILE_ROWS, wires.rows - tile.row);
  tile.cols = min((uint)PF_TILE_COLS, wires.cols - tile.col);
  const size_t first = (size_t)across * wires.rows + tile.row;
  global float* const gains = wires.column + (size_t)down * wires.cols + tile.col;
#ifdef PF_SKIP_IDLE
#ifdef PF_SCALAR
  local TileRange ranges[PF_TILE_ITEMS];
  const TileRange range = range_in_group(raw, planes, layout, tile, ranges);
#else
  const TileRange range = range_of_tile(raw, planes, layout, tile);
#endif
  /* An idle tile sweeps nothing: to return here would part its group at the barriers. */
  if (find_idle_tile(range, tile, wires, first, gains, planes.stages)) tile.rows = tile.cols = 0;
#endif
  sweep_tile(raw, planes, layout, tile, wires.row + first, wires.own + first, gains);
#ifdef PF_SKIP_IDLE
  bound_rows(range, tile, wires, first, gains, planes.stages);
#endif
}

#endif
