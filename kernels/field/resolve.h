/* A contact's ambiguous pillars, resolved together: each way of telling their normal forces is
 * tried, the contact's own evidence chooses one, or none (docs/derivations/field.md). All
 * work-items of a contact call resolve_contact; what they find does not depend on their number. */

static inline Verdict judge_contact(Tile tile, Scratch scratch, Field field, FieldSettings settings,
                                    Share share) {
  const double resolved = scratch.shared[PF_AT_RESOLVED];
  const bool bounded = settings.friction > 0.0f;
  Verdict verdict = verdict_by(bounded ? PF_BY_BOUND : PF_BY_NOTHING, settings.friction);
  if (settings.slips != 0) {
    verdict.way = PF_BY_FRICTION;
    return verdict;
  }
  if (resolved < PF_LEAST_RESOLVED) return verdict;
  float known = 0.0f;
  if (settings.slip != 0) {
    const ShownFriction shown = shown_friction(tile, scratch, field, settings, share);
    if (shown.friction > 0.0f) {
      verdict = verdict_by(PF_BY_SLIP, shown.friction);
      verdict.spread = PF_SPREAD_OF_SHOWN;
      verdict.may_stick = shown.share < PF_ALL_SLIP ? 1 : 0;
      known = shown.friction;
      const bool few = scratch.shared[PF_AT_OPEN] < PF_FEW_OPEN * scratch.shared[PF_AT_LOADED];
      if (verdict.may_stick == 0 || few) return verdict;
    }
  }
  if (settings.shape == 0) return verdict;
  if (resolved < PF_LEAST_RESOLVED_SHARE * scratch.shared[PF_AT_LOADED]) return verdict;
  weigh_lines(tile, scratch.cells, (float)scratch.shared[PF_AT_PEAK], share);
  await_others();
  return best_shape(tile, scratch, settings, verdict, known, share);
}

/* Resolves one contact. Its verdict is the same for every work-item. */
static inline Verdict resolve_contact(Tile tile, Scratch scratch, Field field, Past past,
                                      PF_GLOBAL const Run* runs, FieldSettings settings,
                                      Share share) {
  clear_tile(tile, scratch.cells, field, share);
  await_others();
  load_tile(tile, scratch.cells, field, runs, share);
  await_others();
  summarise_lines(tile, scratch.cells, scratch.lines, share);
  await_others();
  if (share.first == 0) share_summary(tile, scratch);
  await_others();
  const Verdict verdict = judge_contact(tile, scratch, field, settings, share);
  write_contact(tile, scratch.cells, field, past, verdict, settings, share);
  return verdict;
}

/* The middle that a pillar keeps where its contact is not resolved, by itself (F4, F6). */
static inline void resolve_alone(Field field, Past past, uint index, FieldSettings settings) {
  const Force middle = force_of_field(field, index);
  if (!(middle.normal > 0.0f)) return;
  const Segment segment = segment_of(middle, moves_vertically((Bits)field.status[index]));
  const Verdict verdict =
      verdict_by(settings.slips != 0 ? PF_BY_FRICTION : PF_BY_NOTHING, settings.friction);
  const Judgement judgement = judged_normal(segment, verdict, settings, 0.0f);
  write_judgement(field, past, index, segment, judgement, verdict.way > PF_BY_BOUND,
                  settings.noise);
}
