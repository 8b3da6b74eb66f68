/* What the trend leaves of the pressure at resolved pillars, and how it goes on between them: as
 * the membrane that it holds up (docs/derivations/field.md, section 4). */

#define PF_ANCHOR_WEIGHT 0.25f /* of a resolved pillar that counts as such */
#define PF_OVERRELAXATION 1.5f

static inline bool is_anchor(Cells cells, uint cell) {
  return cells.kind[cell] == PF_CELL_RESOLVED && cells.weight[cell] > PF_ANCHOR_WEIGHT;
}

/* The weight of the strongest edge beside a cell outside. */
static inline float weight_outside(Cells cells, uint cell, int width, float peak) {
  const int steps[4] = {1, -1, width, -width};
  float weight = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const uint pillar = (uint)((int)cell + steps[i]);
    if (cells.kind[pillar] < PF_CELL_LOADED) continue;
    const float of_edge = edge_weight(cells, pillar, steps[i], peak);
    if (weight < of_edge) weight = of_edge;
  }
  return weight;
}

/* Residuals where they are known: at anchors, and outside, where a pressure that vanishes
 * there leaves nothing of a positive trend. Zero elsewhere. */
static inline void begin_residuals(Tile tile, Cells cells, const Trend* trend, float peak,
                                   Share share) {
  const Frame frame = frame_of(tile);
  const int width = (int)tile.cols + 2;
  for (uint line = share.first; line < tile.rows + 2; line += share.step) {
    const TrendLine polynomial =
        trend_line(trend, (frame.row - ((double)line - 1.0)) * frame.scale);
    for (uint at = 0; at < tile.cols + 2; ++at) {
      const uint cell = tile.first_cell + line * (tile.cols + 2) + at;
      const uchar kind = cells.kind[cell];
      const bool inside = line >= 1 && line <= tile.rows && at >= 1 && at <= tile.cols;
      double residual = 0.0;
      const bool held = inside && is_anchor(cells, cell);
      if (held || kind == PF_CELL_OUTSIDE) {
        const double value = on_line(&polynomial, ((double)at - 1.0 - frame.col) * frame.scale);
        if (held) {
          residual = powered(trend->squared, (double)cells.top[cell]) - value;
        } else if (value > 0.0) {
          /* A cell on the rim has one neighbour in the box, of which alone an edge can be. */
          const bool corner =
              (line == 0 || line == tile.rows + 1) && (at == 0 || at == tile.cols + 1);
          float weight = 0.0f;
          if (inside) {
            weight = weight_outside(cells, cell, width, peak);
          } else if (!corner) {
            const int inwards =
                line == 0 ? width : (line == tile.rows + 1 ? -width : (at == 0 ? 1 : -1));
            const uint pillar = (uint)((int)cell + inwards);
            if (cells.kind[pillar] >= PF_CELL_LOADED)
              weight = edge_weight(cells, pillar, inwards, peak);
          }
          residual = -(double)weight * value;
        }
      }
      cells.residual[cell] = (float)residual;
    }
  }
}

static inline float neighbour_or_own(Cells cells, uint neighbour, float own) {
  return cells.kind[neighbour] == PF_CELL_BEYOND ? own : cells.residual[neighbour];
}

/* Half a sweep of red-black overrelaxation: the cells of one colour whose residual is open move
 * towards the mean of their neighbours. Where the skin ends nothing holds the membrane. */
static inline void relax_colour(Tile tile, Cells cells, uint colour, Share share) {
  const uint width = tile.cols + 2;
  for (uint row = share.first; row < tile.rows; row += share.step) {
    for (uint col = (row + colour) & 1u; col < tile.cols; col += 2) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] < PF_CELL_LOADED || is_anchor(cells, cell)) continue;
      const float own = cells.residual[cell];
      const float across =
          neighbour_or_own(cells, cell - 1, own) + neighbour_or_own(cells, cell + 1, own);
      const float along =
          neighbour_or_own(cells, cell - width, own) + neighbour_or_own(cells, cell + width, own);
      cells.residual[cell] = own + PF_OVERRELAXATION * (0.25f * (across + along) - own);
    }
  }
}

/* What the trend leaves of the pressure, and the pressure, at the anchors beside ambiguous pillars:
 * sums of both. */
static inline void sum_border(Tile tile, Cells cells, const Trend* trend, PF_GLOBAL double* lines,
                              Share share) {
  const uint sampling = sampling_of(tile);
  const Frame frame = frame_of(tile);
  const uint width = tile.cols + 2;
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    const TrendLine line = trend_line(trend, (frame.row - (double)row) * frame.scale);
    double residuals = 0.0;
    double values = 0.0;
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (!is_anchor(cells, cell)) continue;
      const bool beside = cells.kind[cell - 1] == PF_CELL_AMBIGUOUS ||
                          cells.kind[cell + 1] == PF_CELL_AMBIGUOUS ||
                          cells.kind[cell - width] == PF_CELL_AMBIGUOUS ||
                          cells.kind[cell + width] == PF_CELL_AMBIGUOUS;
      if (!beside) continue;
      const double value = powered(trend->squared, (double)cells.top[cell]);
      residuals += value - on_line(&line, ((double)col - frame.col) * frame.scale);
      values += value;
    }
    PF_GLOBAL double* const sums = lines + (tile.first_line + row) * PF_LINE_SUMS;
    sums[0] = residuals;
    sums[1] = values;
  }
}
