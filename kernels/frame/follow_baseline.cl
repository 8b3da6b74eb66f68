/* Lets the tare follow the readings of untouched sensels, after their frame was solved
 * (docs/calibration.md). Stage PF_BASELINE. */
#ifdef PF_BASELINE

/* The status bits of a pillar's 3 x 3 neighbourhood, or-ed. */
PF_FUNCTION Bits status_around(global const uchar* status, uint row, uint col, uint rows,
                               uint cols) {
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

/* The tares, and the levels that follow from them, under PF_LANES pillars of a row of sensels, of
 * which `lanes` are written; `offset` is the place of the first sensel in the planes. */
PF_FUNCTION void follow_row(global const PF_SENSEL* raw, Calibration calibration, size_t offset,
                            Mask untouched, Real rate, Lanes lanes) {
  const RealPair readings = load_readings(raw);
  const CorrectionPair at = load_corrections(calibration, offset);
  RealPair tares;
  tares.left =
      follow_tare(at.left.tare, validate_reading(readings.left, at.left.good, 0), untouched, rate);
  tares.right = follow_tare(at.right.tare, validate_reading(readings.right, at.right.good, 0),
                            untouched, rate);
  store_pair(tares, (global float*)PF_PLANE_OF(calibration, float, PF_TARE_PLANE) + offset, lanes);
#ifdef PF_SKIP_IDLE
  const RealPair levels = {level_of(tares.left, at.left), level_of(tares.right, at.right)};
  store_readings(levels, (global PF_SENSEL*)activation_thresholds(calibration) + offset, lanes);
#endif
}

/* Follows the tares of one row in `interval` of pillar rows, from `first_row` on: in those of this
 * work-item's band among get_global_size(1), every get_global_size(0)-th block of PF_LANES pillars.
 *
 * raw, calibration, results   as of solve_frame, after it; the tares and levels are written
 * rate                        share of the difference that is taken over, 0..1 */
kernel void follow_baseline(global const PF_SENSEL* restrict raw,
                            global uchar* restrict calibration,
                            global const uchar* restrict results, Layout layout, float rate,
                            uint first_row, uint interval) {
  const Calibration planes = {calibration, layout.plane_bytes, layout.plane_stride};
  global const uchar* const status = results + layout.status;
  const uint rows = (uint)layout.rows;
  const uint cols = (uint)layout.cols;
  const Band band = band_of_rows((rows + interval - 1 - first_row) / interval);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint at = band.first; at < band.end; ++at) {
    const uint row = first_row + at * interval;
    for (uint place = (uint)get_global_id(0) * PF_LANES; place < cols; place += step) {
      /* The last block is moved into the row; its neighbour has followed some of it already. */
      const uint col = min(place, cols - PF_LANES);
      const Lanes lanes = {place - col, PF_LANES};
      const Bits around = status_around(status, row, col, rows, cols);
      const Mask untouched = !mask_of(around & PF_BITS(PF_STATUS_PRESSED));
      for (uint side = 0; side < 2; ++side) {
        follow_row(raw + (2 * row + side) * layout.row_stride + 2 * col, planes,
                   (2 * row + side) * layout.plane_stride + 2 * col, untouched, (Real)(rate),
                   lanes);
      }
    }
  }
}

#endif
