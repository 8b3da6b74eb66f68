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

/* What the counts, the fit and the border say of a model. */
static inline Verdict verdict_of_shape(Scratch scratch, const Trend* trend, double misfit) {
  const Plateau plateau = find_plateau(scratch.counts, PF_IMPLIED_WINDOW);
  Verdict verdict = verdict_by(PF_BY_SHAPE, (float)plateau.ratio);
  verdict.misfit = (float)misfit;
  verdict.score = (float)(plateau.share - 1.5 * plateau.far - misfit);
  verdict.spread = (float)(PF_SCALE_ERRORS * trend->scale_error + misfit +
                           PF_SPREAD_OF_REST * (1.0 - plateau.share));
  return verdict;
}

/* Lets the membrane hold up the trend, and counts what that implies. */
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

/* A model of the pressure's shape. */
typedef struct {
  uint degree;
  bool squared;
  bool relaxed; /* judged with its membrane, in all rows; else by its trend, in sampled ones */
} Model;

/* One model, judged; its trend is the one that is shared. `known` is the friction, or zero. */
static inline Verdict try_model(Tile tile, Scratch scratch, FieldSettings settings, Model model,
                                float known, Share share) {
  const Trend trend =
      fit_trend(tile, scratch, model.degree, model.squared, known, settings.noise, share);
  sum_border(tile, scratch.cells, &trend, scratch.lines, share);
  clear_counts(scratch.counts, share);
  await_others();
  const double misfit = border_misfit(tile, scratch.lines);
  if (model.relaxed) {
    relax_shape(tile, scratch, settings, &trend, share);
  } else {
    evaluate_shape(tile, scratch, &trend, false, settings.noise, share);
    await_others();
  }
  const Verdict verdict = verdict_of_shape(scratch, &trend, misfit);
  await_others();
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

/* What the chosen model gives: the normal forces of its membrane, which hangs on resolved pillars
 * and then, at the friction that it implies or that is known, on those that slip as well. */
static inline Verdict use_model(Tile tile, Scratch scratch, FieldSettings settings, Model model,
                                Verdict best, float known, Share share) {
  const Trend trend = shared_trend(scratch.shared + PF_AT_BEST, model.degree, model.squared);
  relax_shape(tile, scratch, settings, &trend, share);
  Verdict verdict = verdict_of_shape(scratch, &trend, (double)best.misfit);
  await_others();
  if (known > 0.0f) {
    verdict.friction = known;
    verdict.spread = PF_SPREAD_OF_SHOWN;
  }
  hold_slipping(tile, scratch.cells, verdict.friction, share);
  await_others();
  relax_shape(tile, scratch, settings, &trend, share);
  return verdict;
}

/* The best model whose evidence is good enough: of the pressure and its square, with trends of the
 * second and, where there are pillars enough for it, of the fourth degree. Relaxing costs most, so
 * models are relaxed only where no trend by itself is good enough; and the one that is chosen. */
static inline Verdict best_shape(Tile tile, Scratch scratch, FieldSettings settings,
                                 Verdict otherwise, float known, Share share) {
  Verdict best = otherwise;
  Model chosen = {0, false, false};
  for (uint number = 0; number < 8; ++number) {
    const Model model = {(number & 2u) == 0 ? 2u : 4u, (number & 1u) == 0, number >= 4};
    if (scratch.shared[PF_AT_RESOLVED] < 4.0 * (double)terms_of(model.degree)) continue;
    if (number == 4 && chosen.degree != 0) break;
    const Verdict verdict = try_model(tile, scratch, settings, model, known, share);
    if (!is_believed(verdict, scratch, known)) continue;
    if (chosen.degree != 0 && !(verdict.score > best.score)) continue;
    best = verdict;
    chosen = model;
    const bool good = best.score > (float)PF_GOOD_SCORE &&
                      scratch.shared[PF_AT_TREND + PF_TREND_UNEXPLAINED] < PF_GOOD_UNEXPLAINED;
    await_others();
    if (share.first == 0) {
      for (uint i = 0; i < PF_SHARED_TREND; ++i) {
        scratch.shared[PF_AT_BEST + i] = scratch.shared[PF_AT_TREND + i];
      }
    }
    await_others();
    if (good) break;
  }
  if (chosen.degree == 0) return otherwise;
  return use_model(tile, scratch, settings, chosen, best, known, share);
}
