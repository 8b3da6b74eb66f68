/* All flanks of a contact: what they say of the friction, and what pillars bear by them
 * (docs/derivations/field.md, sections 3 and 5). */

#define PF_FLANK_FRICTION 2.0f /* from which the rounds start; they do not depend on it much, */
#define PF_FLANK_ROUNDS 3u     /* for at another friction all that slips bears another part */

/* Pillars of a row or a column of the box. */
typedef struct {
  uint first; /* cell */
  int along;  /* from one cell to the next */
  uint count;
} FlankLine;

static inline FlankLine flank_row(Tile tile, uint row) {
  const FlankLine line = {cell_at(tile, row, 0), 1, tile.cols};
  return line;
}

static inline FlankLine flank_column(Tile tile, uint col) {
  const FlankLine line = {cell_at(tile, 0, col), (int)tile.cols + 2, tile.rows};
  return line;
}

/* The line from its other end. */
static inline FlankLine reversed(FlankLine line) {
  const FlankLine back = {(uint)((int)line.first + ((int)line.count - 1) * line.along), -line.along,
                          line.count};
  return back;
}

/* Counts the open pillars of a flank; none where it does not end with the contact. */
static inline uint open_pillars(Cells cells, Flank flank) {
  int open = 0;
  while (cells.kind[flank_cell(flank, open + 1)] == PF_CELL_AMBIGUOUS) ++open;
  if (cells.kind[flank_cell(flank, open + 1)] >= PF_CELL_LOADED || open == 0) return 0;
  return (uint)open - 1;
}

/* The next flank along a line from its place `*at` on, which it leaves behind the core. */
static inline Flank next_flank(Cells cells, FlankLine line, uint* at) {
  Flank flank = {line.first, line.along, 0, 0};
  while (*at < line.count) {
    const uint cell = (uint)((int)line.first + (int)*at * line.along);
    const uchar kind = cells.kind[cell];
    if (kind == PF_CELL_AMBIGUOUS && flank.core >= PF_FLANK_LEAST_CORE) {
      flank.open = open_pillars(cells, flank);
      if (flank.open >= PF_FLANK_LEAST_RING) return flank;
    }
    if (kind != PF_CELL_RESOLVED) {
      flank.core = 0;
    } else if (flank.core < PF_FLANK_SIDE) {
      ++flank.core;
    }
    flank.last = cell;
    ++*at;
  }
  flank.core = 0;
  return flank;
}

/* A line's record of doubles: sums over its flanks */
#define PF_FLANKS_PRECISION 0 /* of FlankFit, */
#define PF_FLANKS_PULL 1
#define PF_FLANKS_SQUARE 2
#define PF_FLANKS_FREEDOM 3
#define PF_FLANKS_PRECISION_SQUARE 4 /* of products, */
#define PF_FLANKS_PRODUCT 5
#define PF_FLANKS_PULL_SQUARE 6
#define PF_FLANKS_FIXED 7 /* and of the segments of what slips */
#define PF_FLANKS_MOVING 8
#define PF_FLANKS_COUNT 9
#define PF_FLANKS_SUMS 10

static inline void sum_flank(Cells cells, Flank flank, FlankScale scale, PF_GLOBAL double* sums) {
  const Ring ring = ring_of(cells, flank, scale);
  const FlankFit fit = ring.fit;
  if (!(fit.precision > 0.0)) return;
  sums[PF_FLANKS_PRECISION] += fit.precision;
  sums[PF_FLANKS_PULL] += fit.pull;
  sums[PF_FLANKS_SQUARE] += fit.square;
  sums[PF_FLANKS_FREEDOM] += ring.sums.samples - (double)PF_CUBIC;
  sums[PF_FLANKS_PRECISION_SQUARE] += fit.precision * fit.precision;
  sums[PF_FLANKS_PRODUCT] += fit.precision * fit.pull;
  sums[PF_FLANKS_PULL_SQUARE] += fit.pull * fit.pull;
  sums[PF_FLANKS_COUNT] += 1.0;
  for (uint at = ring.gap + 1; in_ring(flank, ring.gap, at); ++at) {
    const Segment segment = segment_of_cell(cells, flank_cell(flank, (int)at));
    sums[PF_FLANKS_FIXED] += (double)segment.fixed;
    sums[PF_FLANKS_MOVING] += (double)segment.moving;
  }
}

static inline void sum_flanks_along(Cells cells, FlankLine line, FlankScale scale,
                                    PF_GLOBAL double* sums) {
  uint at = 0;
  for (Flank flank = next_flank(cells, line, &at); flank.core > 0;
       flank = next_flank(cells, line, &at)) {
    sum_flank(cells, flank, scale, sums);
  }
}

static inline void sum_flank_line(Cells cells, FlankLine line, FlankScale scale,
                                  PF_GLOBAL double* sums) {
  for (uint i = 0; i < PF_FLANKS_SUMS; ++i) sums[i] = 0.0;
  sum_flanks_along(cells, line, scale, sums);
  sum_flanks_along(cells, reversed(line), scale, sums);
}

/* Evidence is taken from as many columns as from rows at most: their records lie behind those of
 * rows. */
static inline uint column_sampling_of(Tile tile) {
  const uint most = tile.rows < PF_MOST_SAMPLED_ROWS ? tile.rows : PF_MOST_SAMPLED_ROWS;
  return most > 0 ? (tile.cols + most - 1) / most : 1;
}

static inline PF_GLOBAL double* row_record(Tile tile, PF_GLOBAL double* lines, uint row) {
  return lines + (tile.first_line + row) * PF_LINE_SUMS;
}

static inline PF_GLOBAL double* column_record(Tile tile, PF_GLOBAL double* lines, uint number) {
  return row_record(tile, lines, number) + PF_FLANKS_SUMS;
}

static inline void sum_flanks(Tile tile, Cells cells, FlankScale scale, PF_GLOBAL double* lines,
                              Share share) {
  const uint sampling = sampling_of(tile);
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    sum_flank_line(cells, flank_row(tile, row), scale, row_record(tile, lines, row));
  }
  const uint across = column_sampling_of(tile);
  for (uint number = share.first; number * across < tile.cols; number += share.step) {
    sum_flank_line(cells, flank_column(tile, number * across), scale,
                   column_record(tile, lines, number));
  }
}

/* What all flanks say. */
typedef struct {
  double friction;
  double error;  /* standard deviation of the normal force that it stands for, relative */
  double flanks; /* that were asked */
} FlankVerdict;

/* Of the scale that the sums of flanks have: its variance by what their cubics leave, and by how
 * flanks differ. */
static inline double flank_scale_variance(const double* sums, double scale) {
  const double precision = sums[PF_FLANKS_PRECISION];
  const double left = (sums[PF_FLANKS_SQUARE] - scale * sums[PF_FLANKS_PULL]) /
                      ((sums[PF_FLANKS_FREEDOM] - 1.0) * precision);
  const double scatter = (sums[PF_FLANKS_PULL_SQUARE] - 2.0 * scale * sums[PF_FLANKS_PRODUCT] +
                          scale * scale * sums[PF_FLANKS_PRECISION_SQUARE]) /
                         (precision * precision);
  return (left > 0.0 ? left : 0.0) + (scatter > 0.0 ? scatter : 0.0);
}

/* From the sums of flanks, whose pillars slipped at a friction, to the one that they imply: that
 * of the mean of their segments at the scale found (F18). */
static inline FlankVerdict verdict_of_sums(const double* sums, float friction) {
  FlankVerdict verdict = {(double)friction, 1.0, sums[PF_FLANKS_COUNT]};
  if (!(sums[PF_FLANKS_PULL] > 0.0)) return verdict;
  const double scale = sums[PF_FLANKS_PULL] / sums[PF_FLANKS_PRECISION];
  const Segment mean = {(float)sums[PF_FLANKS_FIXED], (float)sums[PF_FLANKS_MOVING], 0.0f};
  const float normal = (float)sqrt(scale) * normal_at_ratio(mean, friction);
  verdict.friction = (double)ratio_on_segment(mean, normal);
  verdict.error = 0.5 * sqrt(flank_scale_variance(sums, scale)) / scale;
  return verdict;
}

static inline void add_record(double* sums, PF_GLOBAL const double* record) {
  for (uint i = 0; i < PF_FLANKS_SUMS; ++i) sums[i] += record[i];
}

static inline FlankVerdict verdict_of_flanks(Tile tile, float friction, PF_GLOBAL double* lines) {
  double sums[PF_FLANKS_SUMS];
  for (uint i = 0; i < PF_FLANKS_SUMS; ++i) sums[i] = 0.0;
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    add_record(sums, row_record(tile, lines, row));
  }
  const uint across = column_sampling_of(tile);
  for (uint number = 0; number * across < tile.cols; ++number) {
    add_record(sums, column_record(tile, lines, number));
  }
  return verdict_of_sums(sums, friction);
}

/* For one work-item. */
static inline void share_flanks(Tile tile, Scratch scratch, float friction) {
  const FlankVerdict verdict = verdict_of_flanks(tile, friction, scratch.lines);
  scratch.shared[PF_AT_FLANKS] = verdict.friction;
  scratch.shared[PF_AT_FLANKS + 1] = verdict.error;
  scratch.shared[PF_AT_FLANKS + 2] = verdict.flanks;
}

static inline FlankVerdict shared_flanks(Scratch scratch) {
  PF_GLOBAL const double* const shared = scratch.shared + PF_AT_FLANKS;
  const FlankVerdict verdict = {shared[0], shared[1], shared[2]};
  return verdict;
}

/* Adds the normal forces that a flank gives its open pillars, and, in place of the residuals, their
 * weights: a narrow gap is bridged best. */
static inline void shape_flank(Cells cells, Flank flank, FlankScale scale) {
  const Ring ring = ring_of(cells, flank, scale);
  const float way = (float)(1 + ring.gap);
  const float weight = 1.0f / (way * way);
  for (uint at = 1; at <= ring.gap || in_ring(flank, ring.gap, at); ++at) {
    const uint cell = flank_cell(flank, (int)at);
    const double slipping = slipping_square(cells, flank, at, scale);
    const double bridged = at <= ring.gap ? on_flank(&ring.fit, at) : 0.0;
    cells.shaped[cell] += weight * (float)sqrt(bridged < slipping ? slipping : bridged);
    cells.residual[cell] += weight;
  }
}

static inline void shape_flanks_along(Cells cells, FlankLine line, FlankScale scale) {
  uint at = 0;
  for (Flank flank = next_flank(cells, line, &at); flank.core > 0;
       flank = next_flank(cells, line, &at)) {
    shape_flank(cells, flank, scale);
  }
}

static inline void shape_rows(Tile tile, Cells cells, FlankScale scale, Share share) {
  for (uint row = share.first; row < tile.rows; row += share.step) {
    const FlankLine line = flank_row(tile, row);
    for (uint col = 0; col < tile.cols; ++col) {
      cells.shaped[line.first + col] = 0.0f;
      cells.residual[line.first + col] = 0.0f;
    }
    shape_flanks_along(cells, line, scale);
    shape_flanks_along(cells, reversed(line), scale);
  }
}

/* The same of columns, and the means of both. A pillar of no flank is left with nothing: it slips.
 */
static inline void shape_columns(Tile tile, Cells cells, FlankScale scale, Share share) {
  for (uint col = share.first; col < tile.cols; col += share.step) {
    const FlankLine line = flank_column(tile, col);
    shape_flanks_along(cells, line, scale);
    shape_flanks_along(cells, reversed(line), scale);
    for (uint row = 0; row < tile.rows; ++row) {
      const uint cell = cell_at(tile, row, col);
      if (cells.residual[cell] > 0.0f) cells.shaped[cell] /= cells.residual[cell];
    }
  }
}
