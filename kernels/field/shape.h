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

/* A model, fitted, and judged by its trend in sampled rows. `known` is the friction, or zero. */
static inline Verdict judge_trend(Tile tile, Scratch scratch, FieldSettings settings, Model model,
                                  float known, Share share) {
  const Trend trend = fit_trend(tile, scratch, model, known, settings.noise, share);
  sum_border(tile, scratch.cells, &trend, scratch.lines, share);
  clear_counts(scratch.counts, share);
  await_others();
  const double misfit = border_misfit(tile, scratch.lines);
  if (share.first == 0) scratch.shared[model.shared + PF_TREND_MISFIT] = misfit;
  evaluate_shape(tile, scratch, &trend, false, settings.noise, share);
  await_others();
  const Verdict verdict = verdict_of_shape(scratch, &trend, misfit);
  await_others();
  return verdict;
}

/* A model that was fitted, judged with its membrane in all rows. */
static inline Verdict judge_relaxed(Tile tile, Scratch scratch, FieldSettings settings, Model model,
                                    Share share) {
  PF_GLOBAL const double* const shared = scratch.shared + model.shared;
  const Trend trend = shared_trend(shared, model.degree, model.squared);
  relax_shape(tile, scratch, settings, &trend, share);
  const Verdict verdict = verdict_of_shape(scratch, &trend, shared[PF_TREND_MISFIT]);
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
                                float known, Share share) {
  Verdict verdict = judge_relaxed(tile, scratch, settings, model, share);
  if (known > 0.0f) {
    verdict.friction = known;
    verdict.spread = PF_SPREAD_OF_SHOWN;
  }
  hold_slipping(tile, scratch.cells, verdict.friction, share);
  await_others();
  const Trend trend = shared_trend(scratch.shared + model.shared, model.degree, model.squared);
  relax_shape(tile, scratch, settings, &trend, share);
  return verdict;
}

/* The best model whose evidence is good enough: of the pressure and its square, with trends of the
 * second and, where there are pillars enough for it, of the fourth degree. Relaxing costs most, so
 * models are relaxed only where no trend by itself is good enough; and the one that is chosen. */
static inline Verdict best_shape(Tile tile, Scratch scratch, FieldSettings settings,
                                 Verdict otherwise, float known, Share share) {
  float best_score = 0.0f;
  uint chosen = PF_MODELS;
  const uint tries = known > 0.0f ? PF_MODELS : 2 * PF_MODELS;
  for (uint at = 0; at < tries; ++at) {
    if (at == PF_MODELS && chosen != PF_MODELS) break;
    const bool relaxed = at >= PF_MODELS;
    const uint number = relaxed ? at - PF_MODELS : at;
    const Model model = model_of(number);
    if (scratch.shared[PF_AT_RESOLVED] < 4.0 * (double)terms_of(model.degree)) continue;
    const Verdict verdict = relaxed ? judge_relaxed(tile, scratch, settings, model, share)
                                    : judge_trend(tile, scratch, settings, model, known, share);
    if (!is_believed(verdict, scratch, known)) continue;
    if (chosen != PF_MODELS && !(verdict.score > best_score)) continue;
    best_score = verdict.score;
    chosen = number;
    const double unexplained = scratch.shared[model.shared + PF_TREND_UNEXPLAINED];
    if (best_score > (float)PF_GOOD_SCORE && unexplained < PF_GOOD_UNEXPLAINED) break;
  }
  if (chosen == PF_MODELS) return otherwise;
  return use_model(tile, scratch, settings, model_of(chosen), known, share);
}
