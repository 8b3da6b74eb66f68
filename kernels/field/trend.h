/* The trend of a contact's pressure: a polynomial of its square, or of itself, that is fitted to
 * the resolved pillars, to zero at the contact's edge, and, but for a factor, to the pillars that
 * slip (docs/derivations/field.md, section 3). */

#define PF_TREND_TERMS 15  /* of a polynomial of degree 4, the highest, in two variables */
#define PF_TREND_MOMENTS 9 /* powers of x in its normal equations */
#define PF_TREND_RIGHT 5   /* powers of x on their right side */

/* A line's record of doubles: the moments, */
#define PF_LINE_RIGHT PF_TREND_MOMENTS                      /* resolved pillars, */
#define PF_LINE_SQUARE (PF_LINE_RIGHT + PF_TREND_RIGHT)     /* the sum of their squares, */
#define PF_LINE_SLIP (PF_LINE_SQUARE + 1)                   /* slipping pillars, */
#define PF_LINE_SLIP_SQUARE (PF_LINE_SLIP + PF_TREND_RIGHT) /* and theirs */
#define PF_LINE_SUMS (PF_LINE_SLIP_SQUARE + 1)

#define PF_SLIPS_FROM 0.9f /* of the friction: a ratio above it is taken for slip */

/* Coordinates in the box, about -1 to 1. */
typedef struct {
  double row; /* of the centre, pillars */
  double col;
  double scale; /* per pillar */
} Frame;

static inline Frame frame_of(Tile tile) {
  Frame frame;
  const uint larger = tile.rows > tile.cols ? tile.rows : tile.cols;
  frame.row = 0.5 * ((double)tile.rows - 1.0);
  frame.col = 0.5 * ((double)tile.cols - 1.0);
  frame.scale = 2.0 / ((double)larger + 1.0);
  return frame;
}

/* A polynomial, and how it came about. */
typedef struct {
  uint degree;
  bool squared;                 /* of the pressure's square */
  double terms[PF_TREND_TERMS]; /* of x^i y^j in the order of growing i + j */
  double inverse_square; /* of the residual that halves a weight; zero before it is known (F8) */
  float friction;        /* of pillars that slip and join the fit; zero where none do */
  bool told;             /* that friction is certain */
  double scale;          /* of what these bear at that friction, as the fit has it */
  double scale_error;    /* standard deviation of the normal force that it stands for, relative */
  double unexplained;    /* residuals over values, root mean squares, as of a normal force */
} Trend;

static inline Trend no_trend(uint degree, bool squared) {
  Trend trend;
  trend.degree = degree;
  trend.squared = squared;
  for (uint i = 0; i < PF_TREND_TERMS; ++i) trend.terms[i] = 0.0;
  trend.inverse_square = 0.0;
  trend.friction = 0.0f;
  trend.told = false;
  trend.scale = 1.0;
  trend.scale_error = 0.0;
  trend.unexplained = 0.0;
  return trend;
}

static inline uint terms_of(uint degree) { return (degree + 1) * (degree + 2) / 2; }

/* A line of the trend: a polynomial in x. */
typedef struct {
  uint degree;
  double powers[PF_TREND_RIGHT];
} TrendLine;

static inline TrendLine trend_line(const Trend* trend, double y) {
  TrendLine line;
  line.degree = trend->degree;
  double y_power[PF_TREND_RIGHT];
  y_power[0] = 1.0;
  for (uint j = 1; j <= trend->degree; ++j) y_power[j] = y_power[j - 1] * y;
  for (uint i = 0; i <= trend->degree; ++i) line.powers[i] = 0.0;
  uint term = 0;
  for (uint both = 0; both <= trend->degree; ++both) {
    for (uint i = 0; i <= both; ++i) line.powers[i] += trend->terms[term++] * y_power[both - i];
  }
  return line;
}

static inline double on_line(const TrendLine* line, double x) {
  double sum = line->powers[line->degree];
  for (uint i = line->degree; i-- > 0;) sum = sum * x + line->powers[i];
  return sum;
}

static inline double powered(bool squared, double normal) {
  return squared ? normal * normal : normal;
}

/* How far the pressure beside an edge may be taken to vanish there: 1 where the two pillars inside
 * bear nothing, 0 where they bear as much as any (F7). `inwards` leads from the edge's pillar to
 * the next one inside. */
static inline float edge_weight(Cells cells, uint cell, int inwards, float peak) {
  const float beside = cells.top[cell];
  const float inside = cells.top[(uint)((int)cell + inwards)];
  const float steepest = beside < inside ? inside : beside;
  const float rest = 1.0f - steepest / peak;
  return rest > 0.0f ? rest * rest : 0.0f;
}

static inline bool is_edge(Cells cells, uint cell, int outwards) {
  return cells.kind[(uint)((int)cell + outwards)] == PF_CELL_OUTSIDE;
}

/* The weight of a pillar: one on the edge may be covered in part only, and its force then tells
 * less of the pressure (F7). */
static inline float pillar_weight(Cells cells, uint cell, int width, float peak) {
  const int steps[4] = {1, -1, width, -width};
  float weight = 1.0f;
  for (int i = 0; i < 4; ++i) {
    if (!is_edge(cells, cell, steps[i])) continue;
    const float of_edge = edge_weight(cells, cell, -steps[i], peak);
    if (of_edge < weight) weight = of_edge;
  }
  return weight;
}

static inline void weigh_lines(Tile tile, Cells cells, float peak, Share share) {
  for (uint row = share.first; row < tile.rows; row += share.step) {
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] < PF_CELL_RESOLVED) continue;
      cells.weight[cell] = pillar_weight(cells, cell, (int)tile.cols + 2, peak);
    }
  }
}

/* The share of a sample's weight that its residual leaves it (F8). */
static inline double trust(const Trend* trend, double residual) {
  return 1.0 / (1.0 + residual * residual * trend->inverse_square);
}

/* The weight of all edges beside a pillar. */
static inline float edge_weights(Cells cells, uint cell, int width, float peak) {
  const int steps[4] = {1, -1, width, -width};
  float weight = 0.0f;
  for (int i = 0; i < 4; ++i) {
    if (is_edge(cells, cell, steps[i])) weight += edge_weight(cells, cell, -steps[i], peak);
  }
  return weight;
}

/* A pressure's power at a place, and its weight. */
typedef struct {
  double value;
  double weight;
} Sample;

/* An ambiguous pillar that slips, by the trend so far: what it bears at the trend's friction. */
static inline Sample slipping_sample(Cells cells, uint cell, const Trend* trend, double here) {
  Sample sample = {0.0, 0.0};
  const Segment segment = segment_of_cell(cells, cell);
  const float slow = normal_at_ratio(segment, PF_SLIPS_FROM * trend->friction);
  if (!(here < powered(trend->squared, (double)slow))) return sample;
  sample.value = powered(trend->squared, (double)normal_at_ratio(segment, trend->friction));
  sample.weight = (double)cells.weight[cell] * trust(trend, sample.value - here);
  return sample;
}

static inline void add_sample(PF_GLOBAL double* right, PF_GLOBAL double* square, Sample sample,
                              double x, uint degree) {
  double power = sample.weight * sample.value;
  *square += power * sample.value;
  for (uint i = 0; i <= degree; ++i) {
    right[i] += power;
    power *= x;
  }
}

/* The sums of one line. The edge of a contact passes somewhere through the pillars that it covers
 * last, in the mean through their middle: there the pressure is taken to vanish (F7). */
static inline void sum_line(Tile tile, Cells cells, const Trend* trend, float peak, uint row,
                            PF_GLOBAL double* sums) {
  const Frame frame = frame_of(tile);
  const TrendLine line = trend_line(trend, (frame.row - (double)row) * frame.scale);
  for (uint i = 0; i < PF_LINE_SUMS; ++i) sums[i] = 0.0;
  for (uint col = 0; col < tile.cols; ++col) {
    const uint cell = cell_at(tile, row, col);
    const uchar kind = cells.kind[cell];
    if (kind < PF_CELL_LOADED) continue;
    const float edges = edge_weights(cells, cell, (int)tile.cols + 2, peak);
    const bool may_slip = kind == PF_CELL_AMBIGUOUS && trend->friction > 0.0f;
    if (kind != PF_CELL_RESOLVED && !may_slip && !(edges > 0.0f)) continue;
    const double x = ((double)col - frame.col) * frame.scale;
    const double here = on_line(&line, x);
    double moment = (double)edges * trust(trend, here);
    if (kind == PF_CELL_RESOLVED) {
      Sample sample;
      sample.value = powered(trend->squared, (double)cells.top[cell]);
      sample.weight = (double)cells.weight[cell] * trust(trend, sample.value - here);
      add_sample(sums + PF_LINE_RIGHT, sums + PF_LINE_SQUARE, sample, x, trend->degree);
      moment += sample.weight;
    } else if (may_slip) {
      const Sample sample = slipping_sample(cells, cell, trend, here);
      add_sample(sums + PF_LINE_SLIP, sums + PF_LINE_SLIP_SQUARE, sample, x, trend->degree);
      moment += sample.weight;
    }
    for (uint i = 0; i <= 2 * trend->degree; ++i) {
      sums[i] += moment;
      moment *= x;
    }
  }
}

static inline void sum_lines(Tile tile, Cells cells, const Trend* trend, float peak,
                             PF_GLOBAL double* lines, Share share) {
  const uint sampling = sampling_of(tile);
  for (uint row = share.first * sampling; row < tile.rows; row += share.step * sampling) {
    sum_line(tile, cells, trend, peak, row, lines + (tile.first_line + row) * PF_LINE_SUMS);
  }
}
