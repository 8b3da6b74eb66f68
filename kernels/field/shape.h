/* Models of the pressure's shape, and which of them the contact bears out
 * (docs/derivations/field.md, sections 3 to 5). */

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

/* For one work-item. */
static inline void share_misfit(Tile tile, Scratch scratch, Model model) {
  scratch.shared[model.shared + PF_TREND_MISFIT] = border_misfit(tile, scratch.lines);
}

/* What the plateau of the ratios that it implies, the fit and the border say of a model. */
static inline Verdict verdict_of_shape(Plateau plateau, const Trend* trend, double misfit) {
  Verdict verdict = verdict_by(PF_BY_SHAPE, (float)plateau.ratio);
  verdict.misfit = (float)misfit;
  verdict.score = (float)(plateau.share - 1.5 * plateau.far - misfit);
  verdict.spread =
      (float)(PF_SCALE_ERRORS * trend->scale_error + misfit + PF_PLATEAU_SPREADS * plateau.spread +
              PF_SPREAD_OF_REST * (1.0 - plateau.share));
  return verdict;
}

/* Whether a model's evidence is good enough. */
static inline bool is_believed(Verdict verdict, Scratch scratch, Model model, float known) {
  if (!(verdict.score > (float)PF_LEAST_SCORE)) return false;
  const double unexplained = scratch.shared[model.shared + PF_TREND_UNEXPLAINED];
  if (model.degree > 4 && !(unexplained < PF_UNEXPLAINED_AT_SIX)) return false;
  if (known > 0.0f) {
    return fabs(verdict.friction - known) <= (float)PF_FRICTION_APART * known &&
           verdict.misfit <= (float)PF_MISFIT_AT_FRICTION;
  }
  const double share = scratch.shared[PF_AT_RESOLVED] / scratch.shared[PF_AT_LOADED];
  return verdict.friction <= (float)PF_LARGEST_FRICTION &&
         (double)verdict.misfit <= PF_MISFIT_PER_SHARE * share;
}

/* Attempts, in their order: each model, judged by its trend in sampled rows; each again, with its
 * membrane in all rows; and the best one, whose membrane gives the normal forces. */
#define PF_FIRST_RELAXED PF_MODELS
#define PF_USE_BEST (2u * PF_MODELS)

/* The model that is tried, and the best so far whose evidence is good enough. */
typedef struct {
  uint attempt;
  uint best;   /* PF_MODELS where there is none */
  float merit; /* the best one's */
} Choice;

static inline bool is_relaxed(Choice choice) { return choice.attempt >= PF_FIRST_RELAXED; }

static inline uint tried_number(Choice choice) {
  return choice.attempt < PF_USE_BEST ? choice.attempt % PF_MODELS : choice.best;
}

static inline Model tried_model(Choice choice) { return model_of(tried_number(choice)); }

/* The first attempt from `from` on that there are pillars enough for. Relaxing costs most, so
 * models are relaxed only where no trend by itself is good enough and no friction is known; and the
 * one that is chosen. */
static inline uint attempt_from(uint from, Choice choice, Scratch scratch, float known) {
  const bool relaxes = choice.best == PF_MODELS && !(known > 0.0f);
  const uint end = from <= PF_FIRST_RELAXED && !relaxes ? PF_FIRST_RELAXED : PF_USE_BEST;
  for (uint attempt = from; attempt < end; ++attempt) {
    const uint degree = model_of(attempt % PF_MODELS).degree;
    if (!(scratch.shared[PF_AT_RESOLVED] < 4.0 * (double)terms_of(degree))) return attempt;
  }
  return PF_USE_BEST;
}

/* Takes note of the verdict on the model that was tried, and returns what to try next. */
static inline uint attempt_after(Verdict verdict, Scratch scratch, float known, Choice* choice) {
  const Model model = tried_model(*choice);
  PF_GLOBAL const double* const shared = scratch.shared + model.shared;
  const float merit = verdict.score - (float)(PF_MERIT_OF_ERROR * shared[PF_TREND_SCALE_ERROR]);
  const bool better = choice->best == PF_MODELS || merit > choice->merit;
  if (better && is_believed(verdict, scratch, model, known)) {
    choice->best = tried_number(*choice);
    choice->merit = merit;
    if (verdict.score > (float)PF_GOOD_SCORE &&
        shared[PF_TREND_UNEXPLAINED] < PF_GOOD_UNEXPLAINED) {
      return PF_USE_BEST;
    }
  }
  return attempt_from(choice->attempt + 1, *choice, scratch, known);
}
