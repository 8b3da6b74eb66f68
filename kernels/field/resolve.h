/* A contact's ambiguous pillars, resolved together: each way of telling their normal forces is
 * tried, the contact's own evidence chooses one, or none (docs/derivations/field.md). All
 * work-items of a contact call resolve_contact; what they find does not depend on their number. */

/* Resolves one contact. Its verdict is the same for every work-item. They wait for one another at
 * this one place alone, which no condition guards: some compilers copy what follows a barrier once
 * for every condition that it stands under, and for barriers in a row these copies multiply. */
static inline Verdict resolve_contact(Tile tile, Scratch scratch, Field field, Past past,
                                      PF_GLOBAL const Run* runs, FieldSettings settings,
                                      Share share) {
  const Contact contact = {tile, scratch, field, runs, settings, share};
  Course course;
  begin_course(&course);
  do {
    take_step(&contact, &course);
    await_others();
    next_step(&course, scratch, settings);
  } while (course.step != PF_END_OF_COURSE);
  write_contact(tile, scratch.cells, field, past, course.verdict, settings, share);
  return course.verdict;
}

/* The middle of theta, for a pillar whose contact is not resolved, by itself (F4, F6). */
static inline void resolve_alone(Field field, Past past, uint index, FieldSettings settings) {
  const Force point = force_of_field(field, index);
  if (!(point.normal > 0.0f)) return;
  const Segment segment =
      segment_of(point, moves_vertically((Bits)field.status[index]), settings.segment_point);
  const Verdict verdict =
      verdict_by(settings.slips != 0 ? PF_BY_FRICTION : PF_BY_NOTHING, settings.friction);
  const Judgement judgement = judged_normal(segment, verdict, settings, 0.0f);
  write_judgement(field, past, index, segment, judgement, verdict.way > PF_BY_BOUND,
                  settings.noise);
}
