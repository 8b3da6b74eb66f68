/* Updates the tare from the readings of untouched sensels after the frame is solved
 * (docs/calibration.md). Stage PF_BASELINE. */
#ifdef PF_BASELINE

/* Bitwise or of the status bytes of a pillar's 3 x 3 neighbourhood. */
PF_INLINE Bits status_around(global const uchar* status, uint row, uint col, uint rows, uint cols) {
  const uint first = row == 0 ? 0 : row - 1;
  const uint last = row + 1 == rows ? row : row + 1;
  Bits bits = PF_BITS(0);
  for (uint at = first; at <= last; ++at) {
    global const uchar* const line = status + (size_t)at * cols;
    bits = bits | load_status(line, (int)col - 1, cols) | load_status(line, (int)col, cols) |
           load_status(line, (int)col + 1, cols);
  }
  return bits;
}

/* The columns of PF_LANES pillars from `col` on. */
PF_INLINE Real columns_from(uint col) { return PF_CONSTANT(Real, (float)col) + PF_LANE_NUMBERS; }

/* Numbers of PF_LANES blocks from column `col` on; those outside the row are zero. */
PF_INLINE Real load_numbers(global const float* row, int col, uint cols) {
#ifdef PF_SCALAR
  return col >= 0 && (uint)col < cols ? row[col] : 0.0f;
#else
  if (col >= 0 && (uint)col + PF_LANES <= cols) return PF_LOAD_WHOLE(float, row + col);
  float padded[PF_LANES];
  for (uint i = 0; i < PF_LANES; ++i) {
    const int at = col + (int)i;
    padded[i] = at >= 0 && (uint)at < cols ? row[at] : 0.0f;
  }
  return PF_VLOAD(0, padded);
#endif
}

PF_INLINE void store_numbers(Real numbers, global float* row, Lanes lanes) {
#ifdef PF_SCALAR
  *row = numbers;
#else
  float values[PF_LANES];
  PF_VSTORE(numbers, 0, values);
  for (uint i = lanes.first; i < lanes.end; ++i) row[i] = values[i];
#endif
}

/* The memories of a row of blocks: numbers of the peak, the load, the low and the rest of each,
 * `cols` each, in one of two planes, which turns read and write alternately. */
PF_INLINE global float* releases_at(Calibration calibration, uint turn, uint row) {
  return (global float*)PF_PLANE_OF(calibration, float, PF_RELEASE_PLANE + (turn & 1)) +
         (size_t)row * 2 * calibration.stride;
}

/* Updates the memory of the blocks from `col` on, which read `now`; writes that of `lanes`. */
PF_INLINE Release update_release(Calibration calibration, Real now, uint turn, uint row, uint col,
                                 uint rows, uint cols, BaselinePace pace, Lanes lanes) {
  Real peaks = PF_REAL(0.0);
  Real loads = PF_REAL(0.0);
  const uint last = row + 1 == rows ? row : row + 1;
  for (uint at = row == 0 ? 0 : row - 1; at <= last; ++at) {
    global const float* const line = releases_at(calibration, turn + 1, at);
    for (int side = -1; side <= 1; ++side) {
      peaks = peaks + load_numbers(line, (int)col + side, cols);
      loads = loads + load_numbers(line + cols, (int)col + side, cols);
    }
  }
  global const float* const own = releases_at(calibration, turn + 1, row) + col;
  const Release before = {load_numbers(own, 0, cols), load_numbers(own + 2 * cols, 0, cols),
                          load_numbers(own + 3 * cols, 0, cols), load_numbers(own + cols, 0, cols)};
  const Release after = release_after(before, now, peaks, loads + (now - before.now), pace);
  if (pace.step == 0.0f) return before;
  global float* const to = releases_at(calibration, turn, row) + col;
  store_numbers(after.peak, to, lanes);
  store_numbers(after.now, to + cols, lanes);
  store_numbers(after.low, to + 2 * cols, lanes);
  store_numbers(after.rest, to + 3 * cols, lanes);
  return after;
}

/* The load of a sensel, counts; zero if it is missing. */
PF_INLINE Real load_of(Real raw, Correction at, Stages stages) {
  const Sensel sensel = gained_sensel(raw, at, stages);
  return sensel.missing ? PF_REAL(0.0) : sensel.reading;
}

PF_INLINE Real load_of_row(global const PF_SENSEL* raw, Calibration calibration, Place place) {
  const RealPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, place);
  return load_of(readings.left, at.left, calibration.stages) +
         load_of(readings.right, at.right, calibration.stages);
}

/* Updates the tares and activation thresholds of one row of sensels under PF_LANES pillars; writes
 * those of `lanes`. */
PF_INLINE void follow_row(global const PF_SENSEL* raw, Calibration calibration, Place place,
                          Mask follows, Real rate, Real drift, Lanes lanes) {
  const RealPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, place);
  RealPair tares;
  tares.left = follow_tare(at.left.tare, untared_sensel(readings.left, at.left, calibration.stages),
                           follows, rate, drift);
  tares.right =
      follow_tare(at.right.tare, untared_sensel(readings.right, at.right, calibration.stages),
                  follows, rate, drift);
  store_tares(tares, calibration, place, at, lanes);
}

/* Updates the tares of every `interval`-th pillar row from `first_row` on. A work-item updates
 * every get_global_size(0)-th block of PF_LANES pillars in its band of rows.
 *
 * raw, calibration, results   those of solve_frame; tares, activation thresholds and the memories
 *                             of releases are written
 * drift                       added to the tares of sensels that do not follow */
kernel void follow_baseline(global const PF_SENSEL* restrict raw,
                            global uchar* restrict calibration, global uchar* restrict results,
                            Layout layout, constant PlanNumbers* restrict numbers,
                            BaselinePace pace, Drift drift, uint first_row, uint interval) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  global const uchar* const status = results + layout.touched;
  const uint rows = (uint)layout.rows;
  const uint cols = (uint)layout.cols;
  const uint turn = ((uint)layout.frame - 1) / interval;
  const Band band = band_of_rows((rows + interval - 1 - first_row) / interval);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint at = band.first; at < band.end; ++at) {
    const uint row = first_row + at * interval;
    for (uint place = (uint)get_global_id(0) * PF_LANES; place < cols; place += step) {
      /* The last block is shifted into the row; the block before it has updated its first lanes. */
      const uint col = min(place, cols - PF_LANES);
      const Lanes lanes = {place - col, PF_LANES};
      const Place top = {2 * row, 2 * col};
      const Place bottom = {2 * row + 1, 2 * col};
      global const PF_SENSEL* const first = raw + 2 * row * layout.row_stride + 2 * col;
      global const PF_SENSEL* const second = first + layout.row_stride;
      const Real now =
          PF_REAL(0.25) * (load_of_row(first, planes, top) + load_of_row(second, planes, bottom));
      const Release release = update_release(planes, now, turn, row, col, rows, cols, pace, lanes);
      const Bits around = status_around(status, row, col, rows, cols);
      const Mask follows = !mask_of(around & PF_BITS(PF_STATUS_PRESSED)) || is_released(release);
      const Real rate = rate_after(release, pace);
      const Real shift = drift_at(drift, columns_from(col), PF_CONSTANT(Real, (float)row));
      follow_row(first, planes, top, follows, rate, shift, lanes);
      follow_row(second, planes, bottom, follows, rate, shift, lanes);
    }
  }
}

#endif
