/* Fitting a trend (docs/derivations/field.md, section 3). */

/* A trend as work-items share it: its terms, and behind them */
#define PF_TREND_INVERSE_SQUARE 15
#define PF_TREND_FRICTION 16
#define PF_TREND_SCALE_ERROR 17
#define PF_TREND_UNEXPLAINED 18
#define PF_TREND_MISFIT 19 /* the model's, F9 */

#define PF_ROBUST_ROUNDS 2u
#define PF_SLIP_ROUNDS 2u
#define PF_LEAST_SLIP 0.05 /* share of a plateau whose pillars may join the fit */

static inline void share_trend(const Trend* trend, PF_GLOBAL double* shared) {
  for (uint i = 0; i < PF_TREND_TERMS; ++i) shared[i] = trend->terms[i];
  shared[PF_TREND_INVERSE_SQUARE] = trend->inverse_square;
  shared[PF_TREND_FRICTION] = (double)trend->friction;
  shared[PF_TREND_SCALE_ERROR] = trend->scale_error;
  shared[PF_TREND_UNEXPLAINED] = trend->unexplained;
}

/* The trend that another work-item shared. */
static inline Trend shared_trend(PF_GLOBAL const double* shared, uint degree, bool squared) {
  Trend trend = no_trend(degree, squared);
  for (uint i = 0; i < PF_TREND_TERMS; ++i) trend.terms[i] = shared[i];
  trend.inverse_square = shared[PF_TREND_INVERSE_SQUARE];
  trend.friction = (float)shared[PF_TREND_FRICTION];
  trend.scale_error = shared[PF_TREND_SCALE_ERROR];
  trend.unexplained = shared[PF_TREND_UNEXPLAINED];
  return trend;
}

/* A model of the pressure's shape. */
typedef struct {
  uint degree;  /* of its trend */
  bool squared; /* which is of the pressure's square */
  uint shared;  /* where in Scratch::shared it lies */
} Model;

#define PF_MODELS 4u

static inline Model model_of(uint number) {
  const Model model = {number < 2 ? 2u : 4u, (number & 1u) == 0,
                       PF_AT_TRENDS + number * PF_SHARED_TREND};
  return model;
}

/* Fits the trend to resolved pillars and edges: once with plain weights, then with robust ones
 * (F8). */
static inline Trend fit_resolved(Tile tile, Scratch scratch, Model model, Share share) {
  const uint degree = model.degree;
  const bool squared = model.squared;
  PF_GLOBAL double* const shared = scratch.shared + model.shared;
  Trend trend = no_trend(degree, squared);
  const float peak = (float)scratch.shared[PF_AT_PEAK];
  const double unit = powered(squared, (double)peak);
  const double floor_square = 1e-6 * unit * unit;
  NormalEquations plain;
  plain.square = 0.0;
  plain.weight = 0.0;
  for (uint round = 0; round <= PF_ROBUST_ROUNDS; ++round) {
    sum_lines(tile, scratch.cells, &trend, peak, scratch.lines, share);
    await_others();
    if (share.first == 0) {
      const NormalEquations equations = normal_equations(tile, degree, scratch.lines);
      if (round == 0) plain = equations;
      const double precision = solve_trend(equations, &trend);
      assess_trend(&equations, precision, &trend);
      const double square =
          plain.weight > 0.0 ? residual_square(&plain, &trend) / plain.weight : 0.0;
      trend.inverse_square = 1.0 / (square > floor_square ? square : floor_square);
      share_trend(&trend, shared);
    }
    await_others();
    trend = shared_trend(shared, degree, squared);
  }
  return trend;
}

/* Fits the trend again, together with the pillars that slip by the trend so far: at the friction
 * that it implies, where what they bear is known but for a factor, or at one that is known, where
 * it is known altogether (F14). */
static inline Trend fit_trend(Tile tile, Scratch scratch, Model model, float known, float noise,
                              Share share) {
  Trend trend = fit_resolved(tile, scratch, model, share);
  PF_GLOBAL double* const shared = scratch.shared + model.shared;
  const float peak = (float)scratch.shared[PF_AT_PEAK];
  for (uint round = 0; round < PF_SLIP_ROUNDS; ++round) {
    const Plateau plateau = implied_plateau(tile, scratch, &trend, noise, share);
    if (!(known > 0.0f) && !(plateau.share > PF_LEAST_SLIP)) break;
    trend.friction = known > 0.0f ? known : (float)plateau.ratio;
    trend.told = known > 0.0f;
    sum_lines(tile, scratch.cells, &trend, peak, scratch.lines, share);
    await_others();
    if (share.first == 0) {
      const NormalEquations equations = normal_equations(tile, model.degree, scratch.lines);
      const double precision = solve_trend(equations, &trend);
      assess_trend(&equations, precision, &trend);
      share_trend(&trend, shared);
    }
    await_others();
    trend = shared_trend(shared, model.degree, model.squared);
  }
  return trend;
}
