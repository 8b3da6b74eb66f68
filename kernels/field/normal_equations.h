/* From the sums of lines to the trend (docs/derivations/field.md, section 3). */

#define PF_UNKNOWNS (PF_TREND_TERMS + 1) /* terms, and the scale of what slips */

/* Normal equations of the terms, and behind them of the scale. */
typedef struct {
  double matrix[PF_UNKNOWNS][PF_UNKNOWNS];
  double right[PF_UNKNOWNS];
  double square; /* sum of w u^2 of resolved pillars */
  double weight; /* sum of w */
} NormalEquations;

/* Sums of x^i y^j, i + j up to twice the degree, and of u x^i y^j. */
typedef struct {
  double plain[PF_TREND_MOMENTS][PF_TREND_MOMENTS];
  double right[PF_TREND_RIGHT][PF_TREND_RIGHT];
  double slip[PF_TREND_RIGHT][PF_TREND_RIGHT];
  double square;
  double slip_square;
} Moments;

static inline Moments no_moments(void) {
  Moments moments;
  for (uint i = 0; i < PF_TREND_MOMENTS; ++i) {
    for (uint j = 0; j < PF_TREND_MOMENTS; ++j) moments.plain[i][j] = 0.0;
  }
  for (uint i = 0; i < PF_TREND_RIGHT; ++i) {
    for (uint j = 0; j < PF_TREND_RIGHT; ++j) moments.right[i][j] = moments.slip[i][j] = 0.0;
  }
  moments.square = 0.0;
  moments.slip_square = 0.0;
  return moments;
}

static inline void add_line(Moments* moments, PF_GLOBAL const double* sums, double y, uint degree) {
  double power = 1.0;
  for (uint j = 0; j <= 2 * degree; ++j) {
    for (uint i = 0; i + j <= 2 * degree; ++i) moments->plain[i][j] += sums[i] * power;
    for (uint i = 0; i + j <= degree; ++i) {
      moments->right[i][j] += sums[PF_LINE_RIGHT + i] * power;
      moments->slip[i][j] += sums[PF_LINE_SLIP + i] * power;
    }
    power *= y;
  }
  moments->square += sums[PF_LINE_SQUARE];
  moments->slip_square += sums[PF_LINE_SLIP_SQUARE];
}

/* Sampled line by sampled line from the top, whatever work-items summed them. */
static inline NormalEquations normal_equations(Tile tile, uint degree,
                                               PF_GLOBAL const double* lines) {
  const Frame frame = frame_of(tile);
  Moments moments = no_moments();
  for (uint row = 0; row < tile.rows; row += sampling_of(tile)) {
    add_line(&moments, lines + (tile.first_line + row) * PF_LINE_SUMS,
             (frame.row - (double)row) * frame.scale, degree);
  }
  NormalEquations equations;
  const uint scale = terms_of(degree);
  uint a = 0;
  for (uint both = 0; both <= degree; ++both) {
    for (uint i = 0; i <= both; ++i) {
      uint b = 0;
      for (uint other = 0; other <= degree; ++other) {
        for (uint k = 0; k <= other; ++k) {
          equations.matrix[a][b++] = moments.plain[i + k][both - i + other - k];
        }
      }
      equations.matrix[a][scale] = equations.matrix[scale][a] = -moments.slip[i][both - i];
      equations.right[a++] = moments.right[i][both - i];
    }
  }
  equations.matrix[scale][scale] = moments.slip_square;
  equations.right[scale] = 0.0;
  equations.square = moments.square;
  equations.weight = moments.plain[0][0];
  return equations;
}

/* The sum of squared residuals that a trend leaves. */
static inline double residual_square(const NormalEquations* equations, const Trend* trend) {
  const uint terms = terms_of(trend->degree);
  double sum = equations->square;
  for (uint i = 0; i <= terms; ++i) {
    double image = -2.0 * equations->right[i];
    for (uint j = 0; j <= terms; ++j) {
      image += equations->matrix[i][j] * (j < terms ? trend->terms[j] : trend->scale);
    }
    sum += (i < terms ? trend->terms[i] : trend->scale) * image;
  }
  return sum > 0.0 ? sum : 0.0;
}

/* Eliminates the first `count` unknowns, each from the equations below its own. */
static inline void eliminate(NormalEquations* equations, uint count) {
  for (uint pivot = 0; pivot < count; ++pivot) {
    const double diagonal = equations->matrix[pivot][pivot];
    const double inverse = diagonal > 0.0 ? 1.0 / diagonal : 0.0;
    for (uint row = pivot + 1; row < count; ++row) {
      const double factor = equations->matrix[row][pivot] * inverse;
      for (uint col = pivot; col < count; ++col) {
        equations->matrix[row][col] -= factor * equations->matrix[pivot][col];
      }
      equations->right[row] -= factor * equations->right[pivot];
    }
  }
}

/* Solves them for the terms, and for the scale where its friction is not told; a little is added on
 * the diagonal, so that what the samples leave open becomes zero. Returns the precision of the
 * scale: what is left of its equation, zero where it is not asked. */
static inline double solve_trend(NormalEquations equations, Trend* trend) {
  const uint terms = terms_of(trend->degree);
  const bool scales = !trend->told && equations.matrix[terms][terms] > 0.0;
  double trace = 0.0;
  for (uint i = 0; i < terms; ++i) {
    trace += equations.matrix[i][i];
    if (!scales) equations.right[i] -= equations.matrix[i][terms];
  }
  for (uint i = 0; i < terms; ++i) equations.matrix[i][i] += 1e-9 * trace;
  const uint count = terms + (scales ? 1 : 0);
  eliminate(&equations, count);
  double solution[PF_UNKNOWNS];
  for (uint row = count; row-- > 0;) {
    double rest = equations.right[row];
    for (uint col = row + 1; col < count; ++col) {
      rest -= equations.matrix[row][col] * solution[col];
    }
    solution[row] = equations.matrix[row][row] > 0.0 ? rest / equations.matrix[row][row] : 0.0;
  }
  for (uint i = 0; i < terms; ++i) trend->terms[i] = solution[i];
  trend->scale = scales ? solution[terms] : 1.0;
  return scales ? equations.matrix[terms][terms] : 0.0;
}

/* What the fit says of its own error (F15). `precision` is solve_trend's. */
static inline void assess_trend(const NormalEquations* equations, double precision, Trend* trend) {
  const uint terms = terms_of(trend->degree);
  const double power = trend->squared ? 0.5 : 1.0; /* from a relative error of u to one of N */
  const double square = residual_square(equations, trend);
  const double values =
      equations->square + trend->scale * trend->scale * equations->matrix[terms][terms];
  trend->unexplained = values > 0.0 ? power * sqrt(square / values) : 1.0;
  trend->scale_error = 0.0;
  if (trend->told || !(equations->matrix[terms][terms] > 0.0)) return;
  trend->scale_error = precision > 0.0 && trend->scale > 0.0
                           ? power * sqrt(square / (equations->weight * precision)) / trend->scale
                           : 1.0;
}
