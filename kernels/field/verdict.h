/* What a contact's work-items go by and share, and how its verdict looks
 * (docs/derivations/field.md, section 6). */

/* What the plan and its scene say. */
typedef struct {
  float noise;    /* standard deviation of a reading, N; zero where it is not known */
  float quiet;    /* normal force below which a ratio is mostly noise, N */
  float friction; /* bound of shear over normal force; zero where there is none */
  uint slips;     /* every pillar slips at that friction */
  uint shape;     /* the pressure's shape may be used */
  uint slip;      /* friction may be learnt */
  uint sweeps;
  float segment_point; /* where on a segment the direct solve reports the force */
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
  uint may_stick; /* what is taken to slip may as well not */
} Verdict;

#define PF_MODELS 4u /* trends of the pressure's shape, */
#define PF_FLANKS 4u /* and behind them, as a model, what its flanks say */

/* Doubles that the work-items of a contact share: a trend of each model, and behind them */
#define PF_AT_TRENDS 0
#define PF_SHARED_TREND (PF_TREND_TERMS + 5)
#define PF_AT_FLANKS (PF_AT_TRENDS + PF_MODELS * PF_SHARED_TREND) /* a FlankVerdict, */
#define PF_AT_PEAK (PF_AT_FLANKS + 3)
#define PF_AT_OPEN_PEAK (PF_AT_PEAK + 1)
#define PF_AT_RESOLVED (PF_AT_PEAK + 2) /* pillars of the sampled rows */
#define PF_AT_OPEN (PF_AT_PEAK + 3)
#define PF_AT_LOADED (PF_AT_PEAK + 4)
#define PF_SHARED_SUMS (PF_AT_PEAK + 5)

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
#define PF_LEAST_SCORE 0.1
#define PF_GOOD_SCORE 0.5        /* further models are not tried, */
#define PF_GOOD_UNEXPLAINED 0.01 /* if no more is left unexplained */
#define PF_MERIT_OF_ERROR 50.0   /* what a model loses against others by its scale's error */
#define PF_LEAST_FLANKS 6.0      /* that may tell a friction, */
#define PF_FLANK_ERROR 0.02      /* with an error up to this, */
#define PF_FLANK_FRICTION_FROM 1.41421356 /* above it, for the rest none contradicts, */
#define PF_FLANK_DEVIATIONS 2.0           /* by so many standard deviations of it, */
#define PF_FLANK_CONTRADICTED 0.1         /* which so many open pillars may contradict */
#define PF_MISFIT_PER_SHARE 0.45          /* most, by the share of resolved pillars */
#define PF_MISFIT_AT_FRICTION 0.1         /* most, where the friction is known */
#define PF_FRICTION_APART 0.1             /* of a known one and the one a model implies, relative */
#define PF_FEW_OPEN 0.1           /* of a contact's pillars: no model is asked whether they stick */
#define PF_ALL_SLIP 0.9           /* of the pillars that can show friction: so do open ones */
#define PF_LARGEST_FRICTION 4.0   /* that is believed without being told */
#define PF_TRUST_IN_BOUND 0.9f    /* 1: an open pillar is at the bound told */
#define PF_SPREAD_OF_SHOWN 0.0015 /* of a friction however many pillars show it, relative */
#define PF_SCALE_ERRORS 10.0      /* of a friction, by what the fit says of its own error, */
#define PF_FLANK_ERRORS 6.0       /* by what flanks say of theirs, */
#define PF_PLATEAU_SPREADS 0.2    /* by how far the ratios that bear it out are from it, */
#define PF_SPREAD_OF_REST 0.03    /* and by the share that does not */
#define PF_DEVIATION_OF_MIDDLE 0.4f /* of the truth from it, by the length of the segment */
#define PF_BEYOND_STICKING 0.1f     /* of what a model has a pillar bear beyond slip */
#define PF_REACH_OF_STICKING 0.9f   /* of the segment beyond slip, where no model tells */
#define PF_BEYOND_END 2.0f        /* of a segment, by a reading's noise: what slips may lie there */
#define PF_NOISE_AT_RATIO 1.15f   /* in the normal force at a ratio, by what readings alone give */
#define PF_NOISE_OF_RESOLVED 0.7f /* by a reading's, of a resolved pillar */
#define PF_CHANGE_PER_FRAME 0.05f /* of a normal force, relative deviation */
#define PF_MOST_RECALLED 0.15f    /* deviation, by the length of the segment */

/* The most that a pillar of the contact may bear, once it is summarised, N. */
static inline float peak_of(Scratch scratch) { return (float)scratch.shared[PF_AT_PEAK]; }

static inline float clamped(float value, float low, float high) {
  return value < low ? low : (high < value ? high : value);
}

/* A verdict that knows nothing yet. */
static inline Verdict verdict_by(uint way, float friction) {
  Verdict verdict;
  verdict.way = way;
  verdict.friction = friction;
  verdict.score = 0.0f;
  verdict.misfit = 0.0f;
  verdict.spread = 0.0f;
  verdict.may_stick = 0;
  return verdict;
}

static inline void summarise_lines(Tile tile, Cells cells, PF_GLOBAL double* lines, Share share) {
  const uint sampling = sampling_of(tile);
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    float peak = 0.0f;
    float open_peak = 0.0f;
    double resolved = 0.0;
    double open = 0.0;
    double loaded = 0.0;
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      const uchar kind = cells.kind[cell];
      if (kind < PF_CELL_LOADED) continue;
      const float top = cells.top[cell];
      loaded += 1.0;
      if (kind == PF_CELL_RESOLVED) resolved += 1.0;
      if (peak < top) peak = top;
      if (kind != PF_CELL_AMBIGUOUS) continue;
      open += 1.0;
      if (open_peak < top) open_peak = top;
    }
    PF_GLOBAL double* const sums = lines + (tile.first_line + row) * PF_LINE_SUMS;
    sums[0] = (double)peak;
    sums[1] = (double)open_peak;
    sums[2] = resolved;
    sums[3] = open;
    sums[4] = loaded;
  }
}

/* For one work-item. */
static inline void share_summary(Tile tile, Scratch scratch) {
  double peak = 0.0;
  double open_peak = 0.0;
  double resolved = 0.0;
  double open = 0.0;
  double loaded = 0.0;
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    PF_GLOBAL const double* const sums = scratch.lines + (tile.first_line + row) * PF_LINE_SUMS;
    if (peak < sums[0]) peak = sums[0];
    if (open_peak < sums[1]) open_peak = sums[1];
    resolved += sums[2];
    open += sums[3];
    loaded += sums[4];
  }
  scratch.shared[PF_AT_PEAK] = peak;
  scratch.shared[PF_AT_OPEN_PEAK] = open_peak;
  scratch.shared[PF_AT_RESOLVED] = resolved;
  scratch.shared[PF_AT_OPEN] = open;
  scratch.shared[PF_AT_LOADED] = loaded;
}
