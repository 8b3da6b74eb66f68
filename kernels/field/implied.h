/* What a model of the pressure's shape implies for ambiguous pillars: normal forces, and of these
 * the ratios (docs/derivations/field.md, section 5). */

#define PF_IMPLIED_WINDOW 1.15f /* of a plateau of such ratios */

/* The candidate's normal force on a pillar as its shape has it, and how much its box objects. */
typedef struct {
  float normal;
  bool objects;
} Shaped;

static inline Shaped shaped_normal(Cells cells, uint cell, bool squared, double value,
                                   float noise) {
  const float high = cells.top[cell];
  const double pressed = value > 0.0 ? value : 0.0;
  const float normal = (float)(squared ? sqrt(pressed) : pressed);
  const float least = 0.05f * high;
  Shaped shaped;
  shaped.objects = normal < least || normal > 1.03f * high + noise;
  shaped.normal = clamped(normal, least, high);
  return shaped;
}

/* The estimates of a trend, with the membrane on top or without, and the counts of the ratios that
 * they imply: those that are too low to be told as beyond all, those above the box as none. In
 * sampled rows, or in all. */
static inline void evaluate_shape(Tile tile, Scratch scratch, const Trend* trend, bool relaxed,
                                  float noise, Share share) {
  const Cells cells = scratch.cells;
  const Frame frame = frame_of(tile);
  const uint sampling = relaxed ? 1u : sampling_of(tile);
  const float peak = (float)scratch.shared[PF_AT_OPEN_PEAK];
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    const TrendLine line = trend_line(trend, (frame.row - (double)row) * frame.scale);
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] != PF_CELL_AMBIGUOUS) continue;
      double value = on_line(&line, ((double)col - frame.col) * frame.scale);
      if (relaxed) value += (double)cells.residual[cell];
      const Shaped shaped = shaped_normal(cells, cell, trend->squared, value, noise);
      if (relaxed) cells.shaped[cell] = shaped.normal;
      const float part = cells.top[cell] / peak;
      const bool low = shaped.normal < 0.5f * cells.top[cell];
      const uint bin =
          shaped.objects
              ? (low ? PF_RATIO_BEYOND : PF_RATIO_NONE)
              : bin_of_ratio(ratio_on_segment(segment_of_cell(cells, cell), shaped.normal));
      add_count(scratch.counts + bin, (uint)(part * part * 4095.0f));
    }
  }
}
