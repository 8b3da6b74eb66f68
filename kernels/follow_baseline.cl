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

/* The tares of one row of sensels under `count` pillars. */
PF_INLINE void follow_row(global const PF_SENSEL* raw, global const uchar* mask, global float* tare,
                          Mask untouched, Real rate, uint count) {
  const RealPair readings = load_readings(raw, count);
  RealPair good = {(Real)(1.0f), (Real)(1.0f)};
#ifdef PF_MASK
  good = load_mask(mask, count);
#endif
  RealPair tares = load_plane(tare, count);
  tares.left = follow_tare(tares.left, judge_reading(readings.left, good.left), untouched, rate);
  tares.right =
      follow_tare(tares.right, judge_reading(readings.right, good.right), untouched, rate);
  store_pair(tares, tare, count);
}

/* Follows the blocks of a pillar row that are this work-item's. */
PF_INLINE void follow_pillar_row(global const PF_SENSEL* raw, size_t row_stride, uint row,
                                 uint rows, uint cols, global const uchar* mask, global float* tare,
                                 size_t plane_stride, global const uchar* status, Real rate) {
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint col = (uint)get_global_id(0) * PF_LANES; col < cols; col += step) {
    const uint count = min(cols - col, (uint)PF_LANES);
    const Bits pressed = PF_BITS(PF_STATUS_PRESSED);
    const Mask untouched = !mask_of(status_around(status, row, col, rows, cols) & pressed);
    global const PF_SENSEL* const first = raw + 2 * row * row_stride + 2 * col;
    const size_t offset = 2 * row * plane_stride + 2 * col;
    follow_row(first, mask + offset, tare + offset, untouched, rate, count);
    follow_row(first + row_stride, mask + offset + plane_stride, tare + offset + plane_stride,
               untouched, rate, count);
  }
}

/* One work-item follows every get_global_size(0)-th block of PF_LANES pillars, in the rows of its
 * band among get_global_size(1).
 *
 * raw     readings, `row_stride` apart from one row of sensels to the next
 * mask    calibration plane [.., plane_stride], or null; tare: the same, read and written
 * status  of this frame, [pillar_rows, pillar_cols]
 * rate    share of the difference that is taken over, 0..1 */
kernel void follow_baseline(global const PF_SENSEL* restrict raw, ulong row_stride,
                            uint pillar_rows, uint pillar_cols, global const uchar* restrict mask,
                            ulong plane_stride, global const uchar* restrict status,
                            global float* restrict tare, float rate) {
  const Band band = band_of_rows(pillar_rows);
  for (uint row = band.first; row < band.end; ++row) {
    follow_pillar_row(raw, row_stride, row, pillar_rows, pillar_cols, mask, tare, plane_stride,
                      status, (Real)(rate));
  }
}

#endif
