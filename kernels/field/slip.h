/* The friction that resolved pillars show, because they slip (docs/derivations/field.md, section
 * 5). */

/* Shear over normal force of a pillar, and the largest ratio at which, sheared that way, it would
 * still be resolved (F10). */
typedef struct {
  float ratio;
  float ceiling;
} Slope;

static inline Slope slope_of(Force force) {
  const float shear = length_2(force.shear_x, force.shear_y);
  const float rising = fabs(force.shear_x + force.shear_y);
  const float falling = fabs(force.shear_x - force.shear_y);
  const float least = 0.70710678118654752440f * (rising < falling ? rising : falling);
  Slope slope;
  slope.ratio = shear / force.normal;
  slope.ceiling = least > 0.0f ? shear / least : 1e30f;
  return slope;
}

/* Counts the ratios of resolved pillars, by their normal force, that would have been resolved at a
 * tenth more, or at a tenth more than `plateau`, which is zero in the first round. */
static inline void count_slopes(Tile tile, Scratch scratch, Field field, float quiet, float plateau,
                                Share share) {
  const uint sampling = sampling_of(tile);
  const float peak = peak_of(scratch);
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    for (uint col = 0; col < tile.cols; ++col) {
      if (scratch.cells.kind[cell_at(tile, row, col)] != PF_CELL_RESOLVED) continue;
      const Force force = force_of_field(field, (tile.row + row) * field.cols + tile.col + col);
      if (!(force.normal > quiet)) continue;
      const Slope slope = slope_of(force);
      if (!(slope.ratio * force.normal > quiet)) continue;
      const float beyond = plateau > 0.0f ? plateau : slope.ratio;
      if (!(slope.ceiling > 1.1f * beyond)) continue;
      add_count(scratch.counts + bin_of_ratio(slope.ratio), (uint)(force.normal / peak * 4095.0f));
      add_count(scratch.counts + PF_RATIO_PILLARS, 1);
    }
  }
}

/* The width of a plateau of such ratios: noise spreads those of pillars that bear little. */
static inline float slopes_window(Scratch scratch, float noise) {
  return 1.06f + 4.0f * noise / peak_of(scratch);
}

/* Counts the open pillars, by the square of what they may bear, and behind them those that could
 * not slip at a friction: their least ratio is above it. */
static inline void count_contradictions(Tile tile, Scratch scratch, float noise, float friction,
                                        Share share) {
  const uint sampling = sampling_of(tile);
  const Cells cells = scratch.cells;
  const float peak = (float)scratch.shared[PF_AT_OPEN_PEAK];
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] != PF_CELL_AMBIGUOUS) continue;
      const float high = cells.top[cell];
      const float part = high / peak;
      const bool contradicts =
          normal_at_ratio(segment_of_cell(cells, cell), friction) > 1.02f * high + noise;
      add_count(scratch.counts + (contradicts ? 1 : 0), (uint)(part * part * 4095.0f));
    }
  }
}

/* The friction that resolved pillars show, and how many of those that can show it do. */
typedef struct {
  float friction; /* zero where none is shown */
  float spread;   /* its standard deviation, relative (F12) */
  double share;   /* of their normal force */
} ShownFriction;

/* What was counted to find it. */
typedef struct {
  Plateau plateau;   /* of the slopes */
  double telling;    /* pillars whose slopes were counted */
  double agree;      /* open pillars that may slip at that friction */
  double contradict; /* and that may not */
} SlipEvidence;

/* The friction that resolved pillars show, and that open ones do not contradict, of a contact with
 * so many loaded pillars. */
static inline ShownFriction shown_friction(const SlipEvidence* evidence, double loaded) {
  const Plateau plateau = evidence->plateau;
  const bool ends =
      plateau.above <= 0.05 || (plateau.share >= 0.5 && plateau.above <= 0.3 * plateau.share);
  const bool shows = plateau.share >= 0.1 && ends && evidence->telling >= 0.2 * loaded &&
                     evidence->contradict <= 0.1 * (evidence->agree + evidence->contradict);
  ShownFriction shown = {0.0f, 0.0f, 0.0};
  if (!shows) return shown;
  shown.friction = (float)plateau.ratio;
  shown.spread = (float)(PF_SPREAD_OF_SHOWN + plateau.spread / sqrt(evidence->telling));
  shown.share = plateau.share + plateau.above;
  return shown;
}
