/* The trend of a contact's pressure: a polynomial of its square, or of itself, that is fitted to
 * the resolved pillars and to zero at the contact's edge (docs/derivations/field.md, section 3). */

#define PF_TREND_MOST_DEGREE 4
#define PF_TREND_TERMS 15  /* of a polynomial of degree 4 in two variables */
#define PF_TREND_MOMENTS 9 /* powers of x in its normal equations */
#define PF_TREND_RIGHT 5   /* powers of x on their right side */
#define PF_LINE_SUMS 15    /* doubles of a line's record: moments, right side, square */

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

/* Coefficients of x^i y^j in the order of growing i + j, and for the robust weights the inverse
 * square of the residual that halves a weight: zero in the first round. */
typedef struct {
  uint degree;
  bool squared; /* of the pressure's square */
  double terms[PF_TREND_TERMS];
  double inverse_square;
} Trend;

static inline uint terms_of(uint degree) { return (degree + 1) * (degree + 2) / 2; }

/* A line of the trend: a polynomial in x. */
typedef struct {
  double powers[PF_TREND_RIGHT];
} TrendLine;

static inline TrendLine trend_line(const Trend* trend, double y) {
  TrendLine line;
  for (uint i = 0; i < PF_TREND_RIGHT; ++i) line.powers[i] = 0.0;
  double y_power[PF_TREND_RIGHT];
  y_power[0] = 1.0;
  for (uint j = 1; j < PF_TREND_RIGHT; ++j) y_power[j] = y_power[j - 1] * y;
  uint term = 0;
  for (uint both = 0; both <= trend->degree; ++both) {
    for (uint i = 0; i <= both; ++i) line.powers[i] += trend->terms[term++] * y_power[both - i];
  }
  return line;
}

static inline double on_line(const TrendLine* line, double x) {
  double sum = line->powers[PF_TREND_RIGHT - 1];
  for (uint i = PF_TREND_RIGHT - 1; i-- > 0;) sum = sum * x + line->powers[i];
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

/* The weight of a resolved pillar: a pillar on the edge may be covered in part only, and its force
 * then tells less of the pressure (F7). */
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
      if (cells.kind[cell] != PF_CELL_RESOLVED) continue;
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

/* The sums of one line. The edge of a contact passes somewhere through the pillars that it covers
 * last, in the mean through their middle: there the pressure is taken to vanish (F7). */
static inline void sum_line(Tile tile, Cells cells, const Trend* trend, float peak, uint row,
                            PF_GLOBAL double* sums) {
  const Frame frame = frame_of(tile);
  const TrendLine line = trend_line(trend, (frame.row - (double)row) * frame.scale);
  for (uint i = 0; i < PF_LINE_SUMS; ++i) sums[i] = 0.0;
  PF_GLOBAL double* const right = sums + PF_TREND_MOMENTS;
  for (uint col = 0; col < tile.cols; ++col) {
    const uint cell = cell_at(tile, row, col);
    const uchar kind = cells.kind[cell];
    if (kind < PF_CELL_LOADED) continue;
    const double x = ((double)col - frame.col) * frame.scale;
    const float edges = edge_weights(cells, cell, (int)tile.cols + 2, peak);
    if (kind != PF_CELL_RESOLVED && !(edges > 0.0f)) continue;
    const double here = on_line(&line, x);
    double moment = (double)edges * trust(trend, here);
    if (kind == PF_CELL_RESOLVED) {
      const double value = powered(trend->squared, (double)cells.top[cell]);
      const double weight = (double)cells.weight[cell] * trust(trend, value - here);
      moment += weight;
      double power = weight * value;
      right[PF_TREND_RIGHT] += power * value;
      for (uint i = 0; i < PF_TREND_RIGHT; ++i) {
        right[i] += power;
        power *= x;
      }
    }
    for (uint i = 0; i < PF_TREND_MOMENTS; ++i) {
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

/* The normal equations of a trend. */
typedef struct {
  double matrix[PF_TREND_TERMS][PF_TREND_TERMS];
  double right[PF_TREND_TERMS];
  double square; /* sum of w u^2 */
  double weight; /* sum of w */
} NormalEquations;

/* Moments of x^i y^j, i + j up to twice the degree, and of u x^i y^j. */
typedef struct {
  double plain[PF_TREND_MOMENTS][PF_TREND_MOMENTS];
  double right[PF_TREND_RIGHT][PF_TREND_RIGHT];
  double square;
} Moments;

static inline void add_line(Moments* moments, PF_GLOBAL const double* sums, double y) {
  double power = 1.0;
  for (uint j = 0; j < PF_TREND_MOMENTS; ++j) {
    for (uint i = 0; i + j < PF_TREND_MOMENTS; ++i) moments->plain[i][j] += sums[i] * power;
    for (uint i = 0; i + j < PF_TREND_RIGHT; ++i) {
      moments->right[i][j] += sums[PF_TREND_MOMENTS + i] * power;
    }
    power *= y;
  }
  moments->square += sums[PF_TREND_MOMENTS + PF_TREND_RIGHT];
}

/* Sampled line by sampled line from the top, whatever work-items summed them. */
static inline NormalEquations normal_equations(Tile tile, uint degree,
                                               PF_GLOBAL const double* lines) {
  const Frame frame = frame_of(tile);
  Moments moments;
  for (uint i = 0; i < PF_TREND_MOMENTS; ++i) {
    for (uint j = 0; j < PF_TREND_MOMENTS; ++j) moments.plain[i][j] = 0.0;
  }
  for (uint i = 0; i < PF_TREND_RIGHT; ++i) {
    for (uint j = 0; j < PF_TREND_RIGHT; ++j) moments.right[i][j] = 0.0;
  }
  moments.square = 0.0;
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    add_line(&moments, lines + (tile.first_line + row) * PF_LINE_SUMS,
             (frame.row - (double)row) * frame.scale);
  }
  NormalEquations equations;
  uint a = 0;
  for (uint both = 0; both <= degree; ++both) {
    for (uint i = 0; i <= both; ++i) {
      uint b = 0;
      for (uint other = 0; other <= degree; ++other) {
        for (uint k = 0; k <= other; ++k) {
          equations.matrix[a][b++] = moments.plain[i + k][both - i + other - k];
        }
      }
      equations.right[a++] = moments.right[i][both - i];
    }
  }
  equations.square = moments.square;
  equations.weight = moments.plain[0][0];
  return equations;
}

/* Solves them by elimination; a little is added on the diagonal, so that what the samples leave
 * open becomes zero. */
static inline void solve_trend(NormalEquations equations, Trend* trend) {
  const uint count = terms_of(trend->degree);
  double trace = 0.0;
  for (uint i = 0; i < count; ++i) trace += equations.matrix[i][i];
  for (uint i = 0; i < count; ++i) equations.matrix[i][i] += 1e-9 * trace;
  for (uint pivot = 0; pivot < count; ++pivot) {
    const double inverse =
        equations.matrix[pivot][pivot] > 0.0 ? 1.0 / equations.matrix[pivot][pivot] : 0.0;
    for (uint row = pivot + 1; row < count; ++row) {
      const double factor = equations.matrix[row][pivot] * inverse;
      for (uint col = pivot; col < count; ++col) {
        equations.matrix[row][col] -= factor * equations.matrix[pivot][col];
      }
      equations.right[row] -= factor * equations.right[pivot];
    }
  }
  for (uint row = count; row-- > 0;) {
    double rest = equations.right[row];
    for (uint col = row + 1; col < count; ++col) {
      rest -= equations.matrix[row][col] * trend->terms[col];
    }
    trend->terms[row] = equations.matrix[row][row] > 0.0 ? rest / equations.matrix[row][row] : 0.0;
  }
}

/* The mean square of the residuals that a trend leaves, by the equations without robust weights. */
static inline double mean_square(const NormalEquations* equations, const Trend* trend) {
  const uint count = terms_of(trend->degree);
  double sum = equations->square;
  for (uint i = 0; i < count; ++i) {
    double image = -2.0 * equations->right[i];
    for (uint j = 0; j < count; ++j) image += equations->matrix[i][j] * trend->terms[j];
    sum += trend->terms[i] * image;
  }
  return equations->weight > 0.0 && sum > 0.0 ? sum / equations->weight : 0.0;
}
