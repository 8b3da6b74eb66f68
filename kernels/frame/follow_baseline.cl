/* Lets the tare follow the readings of untouched sensels, after their frame was solved
 * (docs/calibration.md). Stage PF_BASELINE. */
#ifdef PF_BASELINE

/* The status bits of a pillar's 3 x 3 neighbourhood, or-ed. */
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

/* What is read and written of one row of sensels. */
typedef struct {
  global const PF_SENSEL* raw;
  global const float* gain;
  global const uchar* mask;
  global float* tare;
  global PF_SENSEL* wake;
} SenselRow;

/* The tares, and the levels that follow from them, under PF_LANES pillars, of which `lanes` are
 * written. */
PF_INLINE void follow_row(SenselRow row, Mask untouched, Real rate, Lanes lanes) {
  const RealPair readings = load_readings(row.raw);
  RealPair good = {(Real)(1.0f), (Real)(1.0f)};
#ifdef PF_MASK
  good = load_mask(row.mask);
#endif
  RealPair tares = load_plane(row.tare);
  tares.left = follow_tare(tares.left, judge_reading(readings.left, good.left), untouched, rate);
  tares.right =
      follow_tare(tares.right, judge_reading(readings.right, good.right), untouched, rate);
  store_pair(tares, row.tare, lanes);
#ifdef PF_SKIP_SILENT
  RealPair gains = {(Real)(1.0f), (Real)(1.0f)};
#ifdef PF_GAIN
  gains = load_plane(row.gain);
#endif
  const RealPair levels = {level_of(tares.left, gains.left, good.left),
                           level_of(tares.right, gains.right, good.right)};
  store_readings(levels, row.wake, lanes);
#endif
}

/* Follows the tares of one row in `interval` of pillar rows, from `first_row` on: in those of this
 * work-item's band among get_global_size(1), every get_global_size(0)-th block of PF_LANES pillars.
 *
 * raw     readings, `row_stride` apart from one row of sensels to the next
 * gain, mask   calibration planes [.., plane_stride], or null
 * tare, wake   the same, read and written; wake may be null
 * status  of this frame, [pillar_rows, pillar_cols]
 * rate    share of the difference that is taken over, 0..1 */
kernel void follow_baseline(global const PF_SENSEL* restrict raw, ulong row_stride,
                            uint pillar_rows, uint pillar_cols, global const float* restrict gain,
                            global const uchar* restrict mask, ulong plane_stride,
                            global const uchar* restrict status, global float* restrict tare,
                            global PF_SENSEL* restrict wake, float rate, uint first_row,
                            uint interval) {
  const Band band = band_of_rows((pillar_rows + interval - 1 - first_row) / interval);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint at = band.first; at < band.end; ++at) {
    const uint row = first_row + at * interval;
    for (uint place = (uint)get_global_id(0) * PF_LANES; place < pillar_cols; place += step) {
      /* The last block is moved into the row; its neighbour has followed some of it already. */
      const uint col = min(place, pillar_cols - PF_LANES);
      const Lanes lanes = {place - col, PF_LANES};
      const Bits around = status_around(status, row, col, pillar_rows, pillar_cols);
      const Mask untouched = !mask_of(around & PF_BITS(PF_STATUS_PRESSED));
      for (uint side = 0; side < 2; ++side) {
        const size_t offset = (2 * row + side) * plane_stride + 2 * col;
        const SenselRow sensels = {raw + (2 * row + side) * row_stride + 2 * col, gain + offset,
                                   mask + offset, tare + offset, wake + offset};
        follow_row(sensels, untouched, (Real)(rate), lanes);
      }
    }
  }
}

#endif
