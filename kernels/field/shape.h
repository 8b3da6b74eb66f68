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
static inline bool is_believed(Verdict verdict, Scratch scratch, float known) {
  if (!(verdict.score > (float)PF_LEAST_SCORE)) return false;
  if (known > 0.0f) {
    return fabs(verdict.friction - known) <= (float)PF_FRICTION_APART * known &&
           verdict.misfit <= (float)PF_MISFIT_AT_FRICTION;
  }
  const double share = scratch.shared[PF_AT_RESOLVED] / scratch.shared[PF_AT_LOADED];
  return verdict.friction <= (float)PF_LARGEST_FRICTION &&
         (double)verdict.misfit <= PF_MISFIT_PER_SHARE * share;
}

/* Attempts, in their order: each model, judged by its trend in sampled rows; the flanks; each trend
 * again, with its membrane in all rows; and the best one, which gives the normal forces: flanks
 * theirs, a trend with its membrane. */
#define PF_FIRST_RELAXED (PF_FLANKS + 1u)
#define PF_USE_BEST (PF_FIRST_RELAXED + PF_MODELS)
#define PF_NO_MODEL PF_FIRST_RELAXED

/* The model that is tried, and the best so far whose evidence is good enough. */
typedef struct {
  uint attempt;
  uint best;    /* PF_NO_MODEL where there is none */
  float merit;  /* the best one's */
  float spread; /* of the friction that it implies, relative */
} Choice;

static inline bool is_relaxed(Choice choice) { return choice.attempt >= PF_FIRST_RELAXED; }

static inline bool asks_flanks(Choice choice) { return choice.attempt == PF_FLANKS; }

static inline uint tried_number(Choice choice) {
  if (choice.attempt == PF_USE_BEST) return choice.best;
  return is_relaxed(choice) ? choice.attempt - PF_FIRST_RELAXED : choice.attempt;
}

static inline Model tried_model(Choice choice) { return model_of(tried_number(choice)); }

/* Whether enough pillars are resolved for a trend. */
static inline bool may_fit(Scratch scratch, uint number) {
  const double resolved = scratch.shared[PF_AT_RESOLVED];
  return !(resolved < PF_LEAST_RESOLVED_SHARE * scratch.shared[PF_AT_LOADED]) &&
         !(resolved < 4.0 * (double)terms_of(model_of(number).degree));
}

/* The first attempt from `from` on that there are pillars enough for. Flanks are asked where no
 * friction is known. Relaxing costs most, so models are relaxed only where nothing else is good
 * enough and no friction is known; and the one that is chosen. */
static inline uint attempt_from(uint from, Choice choice, Scratch scratch, float known) {
  const bool relaxes = choice.best == PF_NO_MODEL && !(known > 0.0f);
  const uint end = from <= PF_FIRST_RELAXED && !relaxes ? PF_FIRST_RELAXED : PF_USE_BEST;
  for (uint attempt = from; attempt < end; ++attempt) {
    choice.attempt = attempt;
    const bool asked =
        asks_flanks(choice) ? !(known > 0.0f) : may_fit(scratch, tried_number(choice));
    if (asked) return attempt;
  }
  return PF_USE_BEST;
}

/* Takes note of the verdict on the model that was tried, and returns what to try next. */
static inline uint attempt_after(Verdict verdict, Scratch scratch, float known, Choice* choice) {
  PF_GLOBAL const double* const shared = scratch.shared + tried_model(*choice).shared;
  const float merit = verdict.score - (float)(PF_MERIT_OF_ERROR * shared[PF_TREND_SCALE_ERROR]);
  const bool better = choice->best == PF_NO_MODEL || merit > choice->merit;
  if (better && is_believed(verdict, scratch, known)) {
    choice->best = tried_number(*choice);
    choice->merit = merit;
    choice->spread = verdict.spread;
    if (verdict.score > (float)PF_GOOD_SCORE &&
        shared[PF_TREND_UNEXPLAINED] < PF_GOOD_UNEXPLAINED) {
      return PF_USE_BEST;
    }
  }
  return attempt_from(choice->attempt + 1, *choice, scratch, known);
}

/* What flanks, if they are good enough, say of the friction, which so many open pillars contradict;
 * how far it is off is told as of a trend's (F12). */
static inline Verdict verdict_by_flanks(FlankVerdict flanks, double contradicted) {
  const double spread = PF_FLANK_ERRORS * flanks.error;
  const double least = flanks.friction * (1.0 - PF_FLANK_DEVIATIONS * spread);
  const bool good = flanks.flanks >= PF_LEAST_FLANKS && flanks.error <= PF_FLANK_ERROR &&
                    least >= PF_FLANK_FRICTION_FROM && flanks.friction <= PF_LARGEST_FRICTION &&
                    contradicted <= PF_FLANK_CONTRADICTED;
  Verdict verdict = verdict_by(good ? PF_BY_SHAPE : PF_BY_NOTHING, (float)flanks.friction);
  verdict.spread = (float)spread;
  return verdict;
}

/* Takes note of it, if it is surer than that of the best trend, and returns what to try next. */
static inline uint attempt_after_flanks(Verdict verdict, Scratch scratch, Choice* choice) {
  const bool surer = choice->best == PF_NO_MODEL || verdict.spread < choice->spread;
  if (verdict.way == PF_BY_SHAPE && surer) {
    choice->best = PF_FLANKS;
    choice->spread = verdict.spread;
  }
  return attempt_from(choice->attempt + 1, *choice, scratch, 0.0f);
}
