/* Finds how the wires of each tile act on its readings, before solve_frame reads them. Stage
 * PF_WIRES, with PF_ROW_PER_COUNT, PF_COLUMN_PER_COUNT, PF_IDLE_PER_COUNT, PF_TILE_ROWS and
 * PF_TILE_COLS. */
#ifdef PF_WIRES

#define PF_TILE_PARTS ((PF_TILE_COLS + PF_WIRE_PARTS - 1) / PF_WIRE_PARTS * PF_WIRE_PARTS)

/* Raw readings for the sums; missing sensels count as zero. */
#define PF_DEFINE_SUMMED(name, type)                                          \
  PF_INLINE type name(type reading, type good) {                              \
    const type none = (type)(0.0f);                                           \
    reading = good == (type)(1.0f) ? reading : none;                          \
    return fabs(reading) <= (type)(PF_WIRE_LARGEST_READING) ? reading : none; \
  }
#ifdef PF_LARGEST_READING
#define PF_WIRE_LARGEST_READING PF_LARGEST_READING
#else
#define PF_WIRE_LARGEST_READING 1e9f
#endif
PF_DEFINE_SUMMED(summed_reading, float)
#if PF_LANES > 1
PF_DEFINE_SUMMED(summed_readings, Real)
#endif

/* Reads the first `cols` sensels of a tile's row. */
PF_INLINE void read_tile_row(global const PF_SENSEL* raw, Calibration calibration, size_t offset,
                             uint cols, float* readings) {
  uint col = 0;
#ifdef PF_MASK
  global const uchar* const good = PF_PLANE_OF(calibration, uchar, PF_MASK_PLANE) + offset;
#endif
#if PF_LANES > 1
  for (; col + PF_LANES <= cols; col += PF_LANES) {
    Real valid = (Real)(1.0f);
#ifdef PF_MASK
    valid = PF_TO_REAL(PF_LOAD_WHOLE(uchar, good + col));
#endif
    const Real reading = PF_TO_REAL(PF_LOAD_WHOLE(PF_SENSEL, raw + col));
    PF_STORE_WIRES(summed_readings(reading, valid), readings + col);
  }
#endif
  for (; col < cols; ++col) {
    float valid = 1.0f;
#ifdef PF_MASK
    valid = (float)good[col];
#endif
    readings[col] = summed_reading((float)raw[col], valid);
  }
}

/* A work-item finds the wires of one tile. */
kernel void find_wires(global const PF_SENSEL* restrict raw,
                       global const uchar* restrict calibration, global uchar* restrict results,
                       Layout layout) {
  const Calibration planes = calibration_of(calibration, results, layout);
  const WireVectors wires = planes.wires;
  const WireModel model = {(float)(PF_ROW_PER_COUNT), (float)(PF_COLUMN_PER_COUNT),
                           (float)(PF_IDLE_PER_COUNT)};
  const uint across = (uint)get_global_id(0);
  const uint down = (uint)get_global_id(1);
  const uint first_row = down * PF_TILE_ROWS;
  const uint first_col = across * PF_TILE_COLS;
  const uint rows = min((uint)PF_TILE_ROWS, wires.rows - first_row);
  const uint cols = min((uint)PF_TILE_COLS, wires.cols - first_col);
  global float* const row_factors = wires.row + (size_t)across * wires.rows + first_row;
  global float* const idle_factors = wires.idle + (size_t)across * wires.rows + first_row;
  float readings[PF_TILE_PARTS];
  float columns[PF_TILE_PARTS];
  float next[PF_TILE_PARTS];
  float conductances[PF_TILE_PARTS];
  for (uint i = 0; i < PF_TILE_PARTS; ++i) readings[i] = columns[i] = 0.0f;
  for (uint i = 0; i < rows; ++i) row_factors[i] = idle_factors[i] = 1.0f;
  for (uint sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    for (uint i = 0; i < PF_TILE_PARTS; ++i) next[i] = 0.0f;
    for (uint row = 0; row < rows; ++row) {
      const size_t at = first_row + row;
      read_tile_row(raw + at * layout.row_stride + first_col, planes,
                    at * planes.stride + first_col, cols, readings);
      const RowWires before = {row_factors[row], idle_factors[row]};
      const RowWires after =
          sweep_row(readings, columns, next, conductances, PF_TILE_PARTS, before, model);
      row_factors[row] = after.row;
      idle_factors[row] = after.idle;
    }
    for (uint i = 0; i < PF_TILE_PARTS; ++i) columns[i] = next[i];
  }
  global float* const loads = wires.column + (size_t)down * wires.cols + first_col;
  for (uint col = 0; col < cols; ++col) loads[col] = columns[col];
}

#endif
