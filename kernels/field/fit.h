/* Fitting a trend (docs/derivations/field.md, section 3). */

/* A trend as work-items share it: its terms, and behind them */
#define PF_TREND_INVERSE_SQUARE PF_TREND_TERMS
#define PF_TREND_FRICTION (PF_TREND_TERMS + 1)
#define PF_TREND_SCALE_ERROR (PF_TREND_TERMS + 2)
#define PF_TREND_UNEXPLAINED (PF_TREND_TERMS + 3)
#define PF_TREND_MISFIT (PF_TREND_TERMS + 4) /* the model's, F9 */

#define PF_FIT_ROUNDS 3u   /* to resolved pillars: one with plain weights, the others robust (F8) */
#define PF_SLIP_ROUNDS 2u  /* on top, with pillars that slip (F14) */
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

/* Of the pressure's square and of itself, degree 2; the same, degree 4. */
static inline Model model_of(uint number) {
  const Model model = {2 * (number / 2) + 2, (number & 1u) == 0,
                       PF_AT_TRENDS + number * PF_SHARED_TREND};
  return model;
}

/* A fit on its way. */
typedef struct {
  Trend trend;           /* so far */
  NormalEquations plain; /* of the first round; for the work-item that solves them */
} Fit;

static inline void begin_fit(Model model, Fit* fit) {
  fit->trend = no_trend(model.degree, model.squared);
}

static inline Trend shared_trend_of(Scratch scratch, Model model) {
  return shared_trend(scratch.shared + model.shared, model.degree, model.squared);
}

/* What halves a weight in the rounds that follow: the residual that the trend leaves of the first
 * (F8). */
static inline double inverse_square_of(const Fit* fit, float peak) {
  const double unit = powered(fit->trend.squared, (double)peak);
  const double least = 1e-6 * unit * unit;
  const double square =
      fit->plain.weight > 0.0 ? residual_square(&fit->plain, &fit->trend) / fit->plain.weight : 0.0;
  return 1.0 / (square > least ? square : least);
}

/* From the sums of lines to the trend of a round, shared; for one work-item. In the first rounds to
 * resolved pillars and edges; then together with the pillars that slip by the trend so far, at the
 * friction that it implies, where what they bear is known but for a factor, or at one that is
 * known, where it is known altogether (F14). */
static inline void fit_round(Tile tile, Scratch scratch, Model model, uint round, Fit* fit) {
  const NormalEquations equations = normal_equations(tile, model.degree, scratch.lines);
  if (round == 0) fit->plain = equations;
  const double precision = solve_trend(equations, &fit->trend);
  assess_trend(&equations, precision, &fit->trend);
  if (round < PF_FIT_ROUNDS) {
    fit->trend.inverse_square = inverse_square_of(fit, peak_of(scratch));
  }
  share_trend(&fit->trend, scratch.shared + model.shared);
}
