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

/* Updates the tares and activation thresholds of one row of sensels under PF_LANES pillars; writes
 * those of `lanes`. */
PF_INLINE void follow_row(global const PF_SENSEL* raw, Calibration calibration, Place place,
                          Mask untouched, Real rate, Real drift, Lanes lanes) {
  const RealPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, place);
  RealPair tares;
  tares.left = follow_tare(at.left.tare, untared_sensel(readings.left, at.left, calibration.stages),
                           untouched, rate, drift);
  tares.right =
      follow_tare(at.right.tare, untared_sensel(readings.right, at.right, calibration.stages),
                  untouched, rate, drift);
  store_tares(tares, calibration, place, at, lanes);
}

/* Updates the tares of every `interval`-th pillar row from `first_row` on. A work-item updates
 * every get_global_size(0)-th block of PF_LANES pillars in its band of rows.
 *
 * raw, calibration, results   those of solve_frame; tares and activation thresholds are written
 * rate                        fraction of reading - tare that is added to the tare, 0..1
 * drift                       added to the tares of sensels that are not untouched */
kernel void follow_baseline(global const PF_SENSEL* restrict raw,
                            global uchar* restrict calibration, global uchar* restrict results,
                            Layout layout, constant PlanNumbers* restrict numbers, float rate,
                            Drift drift, uint first_row, uint interval) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  global const uchar* const status = results + layout.touched;
  const uint rows = (uint)layout.rows;
  const uint cols = (uint)layout.cols;
  const Band band = band_of_rows((rows + interval - 1 - first_row) / interval);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint at = band.first; at < band.end; ++at) {
    const uint row = first_row + at * interval;
    for (uint place = (uint)get_global_id(0) * PF_LANES; place < cols; place += step) {
      /* The last block is shifted into the row; the block before it has updated its first lanes. */
      const uint col = min(place, cols - PF_LANES);
      const Lanes lanes = {place - col, PF_LANES};
      const Bits around = status_around(status, row, col, rows, cols);
      const Mask untouched = !mask_of(around & PF_BITS(PF_STATUS_PRESSED));
      const Real shift = drift_at(drift, columns_from(col), PF_CONSTANT(Real, (float)row));
      for (uint side = 0; side < 2; ++side) {
        const Place place = {2 * row + side, 2 * col};
        follow_row(raw + (2 * row + side) * layout.row_stride + 2 * col, planes, place, untouched,
                   PF_CONSTANT(Real, rate), shift, lanes);
      }
    }
  }
}

#endif
