/* Models of the pressure's shape, and which of them the contact bears out
 * (docs/derivations/field.md, sections 3 to 5). */

static inline Trend shared_trend(PF_GLOBAL const double* shared, uint degree, bool squared) {
  Trend trend;
  trend.degree = degree;
  trend.squared = squared;
  for (uint i = 0; i < PF_TREND_TERMS; ++i) trend.terms[i] = shared[i];
  trend.inverse_square = shared[PF_AT_INVERSE_SQUARE];
  return trend;
}

static inline void share_trend(const Trend* trend, PF_GLOBAL double* shared) {
  for (uint i = 0; i < PF_TREND_TERMS; ++i) shared[i] = trend->terms[i];
  shared[PF_AT_INVERSE_SQUARE] = trend->inverse_square;
}

/* Fits the trend: once with plain weights, twice with robust ones (F8). */
static inline Trend fit_trend(Tile tile, Scratch scratch, uint degree, bool squared, Share share) {
  Trend trend;
  trend.degree = degree;
  trend.squared = squared;
  for (uint i = 0; i < PF_TREND_TERMS; ++i) trend.terms[i] = 0.0;
  trend.inverse_square = 0.0;
  const float peak = (float)scratch.shared[PF_AT_PEAK];
  const double unit = powered(squared, (double)peak);
  const double floor_square = 1e-6 * unit * unit;
  NormalEquations plain;
  plain.square = 0.0;
  plain.weight = 0.0;
  for (uint round = 0; round < 3; ++round) {
    sum_lines(tile, scratch.cells, &trend, peak, scratch.lines, share);
    await_others();
    if (share.first == 0) {
      const NormalEquations equations = normal_equations(tile, degree, scratch.lines);
      if (round == 0) plain = equations;
      solve_trend(equations, &trend);
      const double square = mean_square(&plain, &trend);
      trend.inverse_square = 1.0 / (square > floor_square ? square : floor_square);
      share_trend(&trend, scratch.shared);
    }
    await_others();
    trend = shared_trend(scratch.shared, degree, squared);
  }
  return trend;
}

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

/* How far the trend is off, one way, where it hands over to ambiguous pillars; relative (F9). */
static inline double border_misfit(Tile tile, PF_GLOBAL const double* lines) {
  double residuals = 0.0;
  double values = 0.0;
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    residuals += lines[(tile.first_line + row) * PF_LINE_SUMS];
    values += lines[(tile.first_line + row) * PF_LINE_SUMS + 1];
  }
  return values > 0.0 ? fabs(residuals) / values : 1.0;
}

/* What the counts and the border say of a model. */
static inline Verdict verdict_of_shape(Scratch scratch, double misfit) {
  const Plateau plateau = find_plateau(scratch.counts, 1.15f);
  Verdict verdict;
  verdict.way = PF_BY_SHAPE;
  verdict.friction = (float)plateau.ratio;
  verdict.misfit = (float)misfit;
  verdict.score = (float)(plateau.share - 1.5 * plateau.far - misfit);
  verdict.spread = (float)(0.03 + 2.5 * plateau.spread + 3.0 * misfit);
  verdict.doubt = 0.03f + 0.8f * verdict.spread;
  return verdict;
}

/* Lets resolved pillars hold up the trend, and counts what that implies. */
static inline void relax_shape(Tile tile, Scratch scratch, FieldSettings settings,
                               const Trend* trend, Share share) {
  begin_residuals(tile, scratch.cells, trend, (float)scratch.shared[PF_AT_PEAK], share);
  clear_counts(scratch.counts, share);
  await_others();
  for (uint sweep = 0; sweep < 2 * settings.sweeps; ++sweep) {
    relax_colour(tile, scratch.cells, sweep & 1u, share);
    await_others();
  }
  evaluate_shape(tile, scratch, trend, true, settings.noise, share);
  await_others();
}

/* One model of the pressure's shape, judged by its trend in the sampled rows, or relaxed. */
static inline Verdict try_shape(Tile tile, Scratch scratch, FieldSettings settings, uint degree,
                                bool squared, bool relaxed, Share share) {
  const Trend trend = fit_trend(tile, scratch, degree, squared, share);
  sum_border(tile, scratch.cells, &trend, scratch.lines, share);
  clear_counts(scratch.counts, share);
  await_others();
  const double misfit = border_misfit(tile, scratch.lines);
  if (relaxed) {
    relax_shape(tile, scratch, settings, &trend, share);
  } else {
    evaluate_shape(tile, scratch, &trend, false, settings.noise, share);
    await_others();
  }
  const Verdict verdict = verdict_of_shape(scratch, misfit);
  await_others();
  return verdict;
}

/* The best model whose evidence is good enough: of the pressure and its square, with trends of the
 * second and, where there are pillars enough for it, of the fourth degree. Relaxing costs most, so
 * models are relaxed only where no trend by itself is good enough; and the one that is chosen. */
static inline Verdict best_shape(Tile tile, Scratch scratch, FieldSettings settings,
                                 Verdict otherwise, Share share) {
  const double resolved = scratch.shared[PF_AT_RESOLVED];
  const double most_misfit = PF_MISFIT_PER_SHARE * resolved / scratch.shared[PF_AT_LOADED];
  Verdict best = otherwise;
  best.score = (float)PF_LEAST_SCORE;
  uint best_degree = 0;
  bool best_squared = false;
  for (uint model = 0; model < 8; ++model) {
    const uint degree = (model & 2u) == 0 ? 2 : 4;
    const bool squared = (model & 1u) == 0;
    if (resolved < 4.0 * (double)terms_of(degree)) continue;
    if (best.score > (float)PF_GOOD_SCORE || (model == 4 && best_degree != 0)) break;
    const Verdict verdict = try_shape(tile, scratch, settings, degree, squared, model >= 4, share);
    if (!(verdict.score > best.score) || verdict.friction > (float)PF_LARGEST_FRICTION ||
        (double)verdict.misfit > most_misfit) {
      continue;
    }
    best = verdict;
    best_degree = degree;
    best_squared = squared;
    if (share.first == 0) {
      for (uint i = 0; i <= PF_AT_INVERSE_SQUARE; ++i) {
        scratch.shared[PF_AT_BEST + i] = scratch.shared[i];
      }
    }
    await_others();
  }
  if (best_degree == 0) return otherwise;
  const Trend trend = shared_trend(scratch.shared + PF_AT_BEST, best_degree, best_squared);
  relax_shape(tile, scratch, settings, &trend, share);
  const Verdict relaxed = verdict_of_shape(scratch, (double)best.misfit);
  await_others();
  return relaxed;
}
