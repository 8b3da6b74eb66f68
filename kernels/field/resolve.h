/* A contact's ambiguous pillars, resolved together: each way of telling their normal forces is
 * tried, the contact's own evidence chooses one, or none (docs/derivations/field.md). All
 * work-items of a contact call resolve_contact; what they find does not depend on their number. */

/* What the plan and its scene say. */
typedef struct {
  float noise;    /* standard deviation of a reading, N; zero where it is not known */
  float quiet;    /* normal force below which a ratio is mostly noise, N */
  float friction; /* bound of shear over normal force; zero where there is none */
  uint slips;     /* every pillar slips at that friction */
  uint shape;     /* the pressure's shape may be used */
  uint slip;      /* friction may be learnt */
  uint sweeps;
} FieldSettings;

/* How a contact was resolved. */
#define PF_BY_NOTHING 0u  /* its ambiguous pillars keep the middle */
#define PF_BY_BOUND 1u    /* the middle of what a friction bound leaves */
#define PF_BY_FRICTION 2u /* they slip, at the friction given */
#define PF_BY_SLIP 3u     /* they slip, at the friction that resolved pillars show */
#define PF_BY_SHAPE 4u    /* by the pressure's shape, and the friction that it implies */

/* What was found of a contact; for the host, and for the last stage. */
typedef struct {
  uint way;
  float friction; /* of what slips; zero where none was found */
  float score;    /* of the shape */
  float misfit;   /* of the trend where it hands over, relative */
  float spread;   /* standard deviation of the friction, relative */
  float doubt;    /* of the shape's normal force, relative */
} Verdict;

#define PF_SHARED_SUMS 36 /* doubles that the work-items of a contact share */
#define PF_AT_INVERSE_SQUARE 15
#define PF_AT_PEAK 16
#define PF_AT_OPEN_PEAK 17
#define PF_AT_RESOLVED 18 /* pillars of the sampled rows */
#define PF_AT_LOADED 19
#define PF_AT_BEST 20 /* the best trend so far, as the one at hand */

/* Scratch memory of one contact. */
typedef struct {
  Cells cells;
  PF_GLOBAL double* lines;  /* of all tiles */
  PF_GLOBAL double* shared; /* PF_SHARED_SUMS of this one */
  PF_GLOBAL uint* counts;   /* PF_RATIO_COUNTS of this one */
} Scratch;

/* How good evidence must be, and what is taken for granted (docs/derivations/field.md, section
 * 6). The values were tuned on scenes of docs/field.md that do not judge. */
#define PF_LEAST_RESOLVED 12.0 /* pillars */
#define PF_LEAST_RESOLVED_SHARE 0.06
#define PF_LEAST_SCORE 0.15
#define PF_GOOD_SCORE 0.5         /* further models are not tried */
#define PF_MISFIT_PER_SHARE 0.45  /* most, by the share of resolved pillars */
#define PF_LARGEST_FRICTION 4.0   /* that is believed without being told */
#define PF_TRUST_IN_BOUND 0.8f    /* 1: an open pillar is at the bound told */
#define PF_NOISE_OF_NORMAL 0.45f  /* by a reading's, at a given ratio */
#define PF_NOISE_OF_RESOLVED 0.7f /* by a reading's, of a resolved pillar */
#define PF_CHANGE_PER_FRAME 0.05f /* of a normal force, relative deviation */
#define PF_MOST_RECALLED 0.15f    /* deviation, by the length of the segment */

static inline float clamped(float value, float low, float high) {
  return value < low ? low : (high < value ? high : value);
}

/* --- What stands where ------------------------------------------------------------------------ */

static inline void summarise_lines(Tile tile, Cells cells, PF_GLOBAL double* lines, Share share) {
  const uint sampling = sampling_of(tile);
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    float peak = 0.0f;
    float open_peak = 0.0f;
    double resolved = 0.0;
    double loaded = 0.0;
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      const uchar kind = cells.kind[cell];
      if (kind < PF_CELL_LOADED) continue;
      const float top = cells.top[cell];
      loaded += 1.0;
      if (kind == PF_CELL_RESOLVED) resolved += 1.0;
      if (peak < top) peak = top;
      if (kind == PF_CELL_AMBIGUOUS && open_peak < top) open_peak = top;
    }
    PF_GLOBAL double* const sums = lines + (tile.first_line + row) * PF_LINE_SUMS;
    sums[0] = (double)peak;
    sums[1] = (double)open_peak;
    sums[2] = resolved;
    sums[3] = loaded;
  }
}

/* For one work-item. */
static inline void share_summary(Tile tile, Scratch scratch) {
  double peak = 0.0;
  double open_peak = 0.0;
  double resolved = 0.0;
  double loaded = 0.0;
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    PF_GLOBAL const double* const sums = scratch.lines + (tile.first_line + row) * PF_LINE_SUMS;
    if (peak < sums[0]) peak = sums[0];
    if (open_peak < sums[1]) open_peak = sums[1];
    resolved += sums[2];
    loaded += sums[3];
  }
  scratch.shared[PF_AT_PEAK] = peak;
  scratch.shared[PF_AT_OPEN_PEAK] = open_peak;
  scratch.shared[PF_AT_RESOLVED] = resolved;
  scratch.shared[PF_AT_LOADED] = loaded;
}

/* --- Slip that resolved pillars show ---------------------------------------------------------- */

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
  const float peak = (float)scratch.shared[PF_AT_PEAK];
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

static inline Plateau slopes_plateau(Tile tile, Scratch scratch, Field field, float quiet,
                                     float from, float width, Share share) {
  clear_counts(scratch.counts, share);
  await_others();
  count_slopes(tile, scratch, field, quiet, from, share);
  await_others();
  const Plateau plateau = find_plateau(scratch.counts, width);
  await_others();
  return plateau;
}

/* The part of the open pillars, by the square of what they may bear, that could not slip at a
 * friction: their least ratio is above it. */
static inline void count_contradictions(Tile tile, Scratch scratch, float noise, float friction,
                                        float peak, Share share) {
  const uint sampling = sampling_of(tile);
  const Cells cells = scratch.cells;
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

/* The friction that resolved pillars show, and that open ones do not contradict; zero if none. */
static inline float shown_friction(Tile tile, Scratch scratch, Field field, FieldSettings settings,
                                   Share share) {
  /* Noise spreads the ratios of pillars that bear little. */
  const float width = 1.06f + 4.0f * settings.noise / (float)scratch.shared[PF_AT_PEAK];
  const Plateau first = slopes_plateau(tile, scratch, field, settings.quiet, 0.0f, width, share);
  if (!(first.share > 0.0)) return 0.0f;
  const Plateau plateau =
      slopes_plateau(tile, scratch, field, settings.quiet, (float)first.ratio, width, share);
  const float friction = (float)plateau.ratio;
  const double telling = (double)scratch.counts[PF_RATIO_PILLARS];
  const double pillars = scratch.shared[PF_AT_LOADED];
  await_others();
  clear_counts(scratch.counts, share);
  await_others();
  count_contradictions(tile, scratch, settings.noise, friction,
                       (float)scratch.shared[PF_AT_OPEN_PEAK], share);
  await_others();
  const double agree = (double)scratch.counts[0];
  const double contradict = (double)scratch.counts[1];
  await_others();
  const bool ends =
      plateau.above <= 0.05 || (plateau.share >= 0.5 && plateau.above <= 0.3 * plateau.share);
  const bool shows = plateau.share >= 0.1 && ends && telling >= 0.2 * pillars &&
                     contradict <= 0.1 * (agree + contradict);
  return shows ? friction : 0.0f;
}

/* --- The pressure's shape --------------------------------------------------------------------- */

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

/* --- The verdict ------------------------------------------------------------------------------ */

static inline Verdict judge_contact(Tile tile, Scratch scratch, Field field, FieldSettings settings,
                                    Share share) {
  const double resolved = scratch.shared[PF_AT_RESOLVED];
  Verdict verdict;
  verdict.way = settings.friction > 0.0f ? PF_BY_BOUND : PF_BY_NOTHING;
  verdict.friction = settings.friction;
  verdict.score = 0.0f;
  verdict.misfit = 0.0f;
  verdict.spread = 0.0f;
  verdict.doubt = 0.0f;
  if (settings.slips != 0) {
    verdict.way = PF_BY_FRICTION;
    return verdict;
  }
  if (resolved < PF_LEAST_RESOLVED) return verdict;
  if (settings.slip != 0) {
    const float friction = shown_friction(tile, scratch, field, settings, share);
    if (friction > 0.0f) {
      verdict.way = PF_BY_SLIP;
      verdict.friction = friction;
      verdict.spread = 0.005f;
      return verdict;
    }
  }
  if (settings.shape == 0) return verdict;
  if (resolved < PF_LEAST_RESOLVED_SHARE * scratch.shared[PF_AT_LOADED]) return verdict;
  weigh_lines(tile, scratch.cells, (float)scratch.shared[PF_AT_PEAK], share);
  await_others();
  return best_shape(tile, scratch, settings, verdict, share);
}

/* The normal force of an ambiguous pillar, and within what 95 of 100 lie. */
typedef struct {
  float normal;
  float low;
  float high;
} Judgement;

/* What is left open of a pillar that slips at a friction with a relative deviation (F12). */
static inline Judgement slipping_normal(Segment segment, float low, float friction, float spread) {
  Judgement judgement;
  judgement.normal = clamped(normal_at_ratio(segment, friction), low, segment.high);
  judgement.low =
      clamped(normal_at_ratio(segment, friction * (1.0f + 1.96f * spread)), low, segment.high);
  judgement.high =
      clamped(normal_at_ratio(segment, friction * clamped(1.0f - 1.96f * spread, 0.25f, 1.0f)), low,
              segment.high);
  return judgement;
}

/* The normal force that a verdict has (F6, F11). `shaped` is that of the best model, where there is
 * one. */
static inline Judgement judged_normal(Segment segment, Verdict verdict, FieldSettings settings,
                                      float shaped) {
  const float bound = settings.friction > 0.0f
                          ? clamped(normal_at_ratio(segment, settings.friction), 0.0f, segment.high)
                          : 0.0f;
  if (verdict.way > PF_BY_BOUND) {
    const Judgement slipping = slipping_normal(segment, bound, verdict.friction, verdict.spread);
    if (verdict.way != PF_BY_SHAPE || ratio_on_segment(segment, shaped) > 0.9f * verdict.friction) {
      return slipping;
    }
    Judgement judgement;
    judgement.normal = clamped(shaped, slipping.normal, segment.high);
    judgement.low = clamped(shaped * (1.0f - 1.96f * verdict.doubt), slipping.low, segment.high);
    judgement.high = clamped(shaped * (1.0f + 1.96f * verdict.doubt), slipping.low, segment.high);
    return judgement;
  }
  Judgement judgement;
  judgement.normal =
      between_thetas(segment, bound, segment.high, bound > 0.0f ? PF_TRUST_IN_BOUND : 0.5f);
  judgement.low = bound;
  judgement.high = segment.high;
  return judgement;
}

/* The same by what was known of the pillar a frame before, where that says more than the segment
 * (F13). */
static inline bool recalled_normal(Segment segment, Past past, uint index, float noise,
                                   Judgement* judgement) {
  if (past.normal == 0 || past.frame[index] + 1 != past.now) return false;
  const float normal = past.normal[index];
  const float change = PF_CHANGE_PER_FRAME * normal;
  const float deviation = length_3(past.deviation[index], change, PF_NOISE_OF_NORMAL * noise);
  if (deviation > PF_MOST_RECALLED * (judgement->high - judgement->low)) return false;
  const float low = judgement->low;
  judgement->normal = clamped(normal, low, segment.high);
  judgement->low = clamped(normal - 1.96f * deviation, low, segment.high);
  judgement->high = clamped(normal + 1.96f * deviation, low, segment.high);
  return true;
}

/* Keeps what is known of a pillar for the frame that follows. */
static inline void keep_for_next(Past past, uint index, float normal, float deviation) {
  if (past.normal == 0) return;
  past.normal[index] = normal;
  past.deviation[index] = deviation;
  past.frame[index] = past.now;
}

/* The same of the pillars of a run that are resolved by themselves. */
static inline void keep_run(Field field, Past past, Run run, float noise) {
  for (uint col = run.first; col < run.end; ++col) {
    const uint index = run.row * field.cols + col;
    if (!is_determined(field.status[index])) continue;
    keep_for_next(past, index, field.normal[index], PF_NOISE_OF_RESOLVED * noise);
  }
}

/* The ends of direction and magnitude: on the segment theta and magnitude fall as the normal force
 * grows, and phi goes one way. */
static inline void write_ends(Field field, uint index, Force least, Force most) {
  const Direction flat = direction_of(least);
  const Direction steep = direction_of(most);
  const bool clockwise = least.shear_x * most.shear_y < least.shear_y * most.shear_x;
  field.theta_low[index] = steep.theta;
  field.theta_high[index] = flat.theta;
  field.phi_low[index] = clockwise ? steep.phi : flat.phi;
  field.phi_high[index] = clockwise ? flat.phi : steep.phi;
  field.magnitude_low[index] = steep.magnitude;
  field.magnitude_high[index] = flat.magnitude;
}

/* What neighbours left of the uncertainty: of the component that the readings give, nothing new;
 * of the other two, half the width of the judgement, and the readings' noise on top (F12). */
static inline void write_deviations(Field field, uint index, Mask vertical, Judgement judgement,
                                    float noise) {
  const float width = (judgement.high - judgement.low) * (float)(0.5 / 1.96);
  const float normal = length_2(width, PF_NOISE_OF_NORMAL * noise);
  field.deviation_normal[index] = normal;
  if (vertical) {
    field.deviation_y[index] = length_2(1.41421356237309504880f * width, noise);
  } else {
    field.deviation_x[index] = length_2(1.41421356237309504880f * width, noise);
  }
}

/* Writes what was judged of a pillar, or what is recalled of it where nothing resolved it. */
static inline void write_judgement(Field field, Past past, uint index, Segment segment,
                                   Judgement judgement, bool resolved, float noise) {
  const Force middle = force_of_field(field, index);
  const Mask vertical = moves_vertically((Bits)field.status[index]);
  if (!resolved) resolved = recalled_normal(segment, past, index, noise, &judgement);
  if (resolved) {
    const float width = (judgement.high - judgement.low) * (float)(0.5 / 1.96);
    keep_for_next(past, index, judgement.normal, width);
  }
  const Force force = force_on_segment(middle, vertical, judgement.normal);
  field.shear_x[index] = force.shear_x;
  field.shear_y[index] = force.shear_y;
  field.normal[index] = force.normal;
  if (resolved) field.status[index] |= PF_STATUS_FROM_NEIGHBOURS;
  if (field.magnitude != 0) {
    const Direction direction = direction_of(force);
    field.magnitude[index] = direction.magnitude;
    field.theta[index] = direction.theta;
    field.phi[index] = direction.phi;
  }
  if (field.deviation_normal == 0) return;
  write_ends(field, index, force_on_segment(middle, vertical, judgement.low),
             force_on_segment(middle, vertical, judgement.high));
  if (resolved) write_deviations(field, index, vertical, judgement, noise);
}

/* Writes the forces of a contact's ambiguous pillars. */
static inline void write_contact(Tile tile, Cells cells, Field field, Past past, Verdict verdict,
                                 FieldSettings settings, Share share) {
  for (uint row = share.first; row < tile.rows; row += share.step) {
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] != PF_CELL_AMBIGUOUS) continue;
      const uint index = (tile.row + row) * field.cols + tile.col + col;
      const Segment segment = segment_of_cell(cells, cell);
      const Judgement judgement = judged_normal(
          segment, verdict, settings, verdict.way == PF_BY_SHAPE ? cells.shaped[cell] : 0.0f);
      write_judgement(field, past, index, segment, judgement, verdict.way > PF_BY_BOUND,
                      settings.noise);
    }
  }
}

/* Resolves one contact. Its verdict is the same for every work-item. */
static inline Verdict resolve_contact(Tile tile, Scratch scratch, Field field, Past past,
                                      PF_GLOBAL const Run* runs, FieldSettings settings,
                                      Share share) {
  clear_tile(tile, scratch.cells, field, share);
  await_others();
  load_tile(tile, scratch.cells, field, runs, share);
  await_others();
  summarise_lines(tile, scratch.cells, scratch.lines, share);
  await_others();
  if (share.first == 0) share_summary(tile, scratch);
  await_others();
  const Verdict verdict = judge_contact(tile, scratch, field, settings, share);
  write_contact(tile, scratch.cells, field, past, verdict, settings, share);
  return verdict;
}

/* The middle that a pillar keeps where its contact is not resolved, by itself (F4, F6). */
static inline void resolve_alone(Field field, Past past, uint index, FieldSettings settings) {
  const Force middle = force_of_field(field, index);
  if (!(middle.normal > 0.0f)) return;
  const Segment segment = segment_of(middle, moves_vertically((Bits)field.status[index]));
  Verdict verdict;
  verdict.way = settings.slips != 0 ? PF_BY_FRICTION : PF_BY_NOTHING;
  verdict.friction = settings.friction;
  verdict.score = 0.0f;
  verdict.misfit = 0.0f;
  verdict.spread = 0.0f;
  verdict.doubt = 0.0f;
  const Judgement judgement = judged_normal(segment, verdict, settings, 0.0f);
  write_judgement(field, past, index, segment, judgement, verdict.way > PF_BY_BOUND,
                  settings.noise);
}
