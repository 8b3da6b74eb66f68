/* From the verdict on a contact to the forces of its pillars, and what is kept for the frame that
 * follows (docs/derivations/field.md, section 6). */

/* The normal force of an ambiguous pillar, and within what 95 of 100 lie. */
typedef struct {
  float normal;
  float low;
  float high;
} Judgement;

/* The deviation whose band of 95 of 100 holds the judgement's. */
static inline float deviation_of(Judgement judgement) {
  const float above = judgement.high - judgement.normal;
  const float below = judgement.normal - judgement.low;
  return (above > below ? above : below) * (float)(1.0 / 1.96);
}

/* The noise of a normal force at a given ratio, by that of a reading (F17). */
static inline float noise_at_ratio(Segment segment, float normal) {
  const float moving = segment.moving - 1.41421356237309504880f * normal;
  const float shear = length_2(segment.fixed, moving);
  if (!(shear > 0.0f && normal > 0.0f)) return 0.0f;
  const float slope = shear / normal + 1.41421356237309504880f * (moving / shear);
  return PF_NOISE_AT_RATIO / clamped(slope, 1.0f, 1e30f);
}

/* What is left open of a pillar that slips at a friction with a relative deviation (F12). */
static inline Judgement slipping_normal(Segment segment, float low, float friction, float spread) {
  Judgement judgement;
  judgement.normal = clamped(normal_at_ratio(segment, friction), low, segment.high);
  judgement.low =
      clamped(normal_at_ratio(segment, friction * (1.0f + 1.96f * spread)), low, segment.high);
  judgement.high =
      clamped(normal_at_ratio(segment, friction * clamped(1.0f - 1.96f * spread, 0.25f, 1.0f)), low,
              segment.high);
  return judgement;
}

/* The same of a pillar that a model has sticking: whether it does is what is least certain, so the
 * band reaches from where it would slip to the model's force, and beyond both (F12). */
static inline Judgement sticking_normal(Segment segment, Judgement slipping, float shaped) {
  Judgement judgement;
  judgement.normal = clamped(shaped, slipping.normal, segment.high);
  const float beyond = PF_BEYOND_STICKING * (judgement.normal - slipping.normal);
  judgement.low = clamped(slipping.low - beyond, 0.0f, segment.high);
  judgement.high = clamped(judgement.normal + beyond, slipping.high, segment.high);
  return judgement;
}

/* A judgement, weighed against what is known without it: the middle that a bound leaves, of which
 * the truth lies a part of the segment off (F16). Whoever is certain stays. */
static inline Judgement weighed(Judgement judgement, float middle, float high) {
  const float deviation = deviation_of(judgement);
  const float prior = PF_DEVIATION_OF_MIDDLE * high;
  const float weight = prior * prior / (prior * prior + deviation * deviation);
  if (high > 0.0f) judgement.normal = middle + weight * (judgement.normal - middle);
  return judgement;
}

/* What a friction tells by itself: a pillar slips at it, or, where some of its contact sticks, may
 * bear more (F12). */
static inline Judgement judged_by_friction(Segment segment, Judgement slipping, Verdict verdict) {
  Judgement judgement = slipping;
  if (verdict.may_stick != 0) {
    const float rest = PF_REACH_OF_STICKING * (segment.high - slipping.normal);
    judgement.high = clamped(slipping.normal + rest, slipping.high, segment.high);
  }
  return judgement;
}

/* What a model tells besides: that the pillar slips, or that it sticks with the force it has. */
static inline Judgement judged_by_shape(Segment segment, Judgement slipping, Verdict verdict,
                                        float shaped) {
  const bool sticks = ratio_on_segment(segment, shaped) <= PF_SLIPS_FROM * verdict.friction;
  if (!sticks && verdict.may_stick == 0) return slipping;
  Judgement judgement = sticking_normal(segment, slipping, shaped);
  if (!sticks) judgement.normal = slipping.normal;
  return judgement;
}

/* The normal force that a verdict has (F6, F11). `shaped` is that of the best model, where there is
 * one. */
static inline Judgement judged_normal(Segment segment, Verdict verdict, FieldSettings settings,
                                      float shaped) {
  const float bound = settings.friction > 0.0f
                          ? clamped(normal_at_ratio(segment, settings.friction), 0.0f, segment.high)
                          : 0.0f;
  const float part = bound > 0.0f ? PF_TRUST_IN_BOUND : 0.5f;
  if (verdict.way <= PF_BY_BOUND) {
    const Judgement open = {between_thetas(segment, bound, segment.high, part), bound,
                            segment.high};
    return open;
  }
  const bool by_shape = verdict.way == PF_BY_SHAPE;
  Segment reach = segment; /* and beyond it as far as noise may hide readings */
  if (by_shape || verdict.may_stick == 0) reach.high += PF_BEYOND_END * settings.noise;
  const Judgement slipping = slipping_normal(reach, bound, verdict.friction, verdict.spread);
  if (!by_shape) return judged_by_friction(segment, slipping, verdict);
  return weighed(judged_by_shape(reach, slipping, verdict, shaped),
                 between_thetas(segment, bound, segment.high, part), segment.high);
}

/* The same by what was known of the pillar a frame before, where that says more than the segment
 * (F13). */
static inline bool recalled_normal(Segment segment, Past past, uint index, float noise,
                                   Judgement* judgement) {
  if (past.normal == 0 || past.frame[index] + 1 != past.now) return false;
  const float normal = past.normal[index];
  const float change = PF_CHANGE_PER_FRAME * normal;
  const float deviation =
      length_3(past.deviation[index], change, noise_at_ratio(segment, normal) * noise);
  if (deviation > PF_MOST_RECALLED * (judgement->high - judgement->low)) return false;
  const float low = judgement->low;
  judgement->normal = clamped(normal, low, segment.high);
  judgement->low = clamped(normal - 1.96f * deviation, low, segment.high);
  judgement->high = clamped(normal + 1.96f * deviation, low, segment.high);
  return true;
}

/* Keeps what is known of a pillar for the frame that follows. */
static inline void keep_for_next(Past past, uint index, float normal, float deviation) {
  if (past.normal == 0) return;
  past.normal[index] = normal;
  past.deviation[index] = deviation;
  past.frame[index] = past.now;
}

/* The same of the pillars of a run that are resolved by themselves. */
static inline void keep_run(Field field, Past past, Run run, float noise) {
  for (uint col = run.first; col < run.end; ++col) {
    const uint index = run.row * field.cols + col;
    if (!is_determined(field.status[index])) continue;
    keep_for_next(past, index, field.normal[index], PF_NOISE_OF_RESOLVED * noise);
  }
}

/* The ends of direction and magnitude: on the segment theta and magnitude fall as the normal force
 * grows, and phi goes one way. */
static inline void write_ends(Field field, uint index, Force least, Force most) {
  const Direction flat = direction_of(least);
  const Direction steep = direction_of(most);
  const bool clockwise = least.shear_x * most.shear_y < least.shear_y * most.shear_x;
  field.theta_low[index] = steep.theta;
  field.theta_high[index] = flat.theta;
  field.phi_low[index] = clockwise ? steep.phi : flat.phi;
  field.phi_high[index] = clockwise ? flat.phi : steep.phi;
  field.magnitude_low[index] = steep.magnitude;
  field.magnitude_high[index] = flat.magnitude;
}

/* What neighbours left of the uncertainty: of the component that the readings give, nothing new;
 * of the other two, the farther end of the judgement, and the readings' noise on top (F12). */
static inline void write_deviations(Field field, uint index, Segment segment, Mask vertical,
                                    Judgement judgement, float noise) {
  const float deviation = deviation_of(judgement);
  field.deviation_normal[index] =
      length_2(deviation, noise_at_ratio(segment, judgement.normal) * noise);
  if (vertical) {
    field.deviation_y[index] = length_2(1.41421356237309504880f * deviation, noise);
  } else {
    field.deviation_x[index] = length_2(1.41421356237309504880f * deviation, noise);
  }
}

/* Writes what was judged of a pillar, or what is recalled of it where nothing resolved it. */
static inline void write_judgement(Field field, Past past, uint index, Segment segment,
                                   Judgement judgement, bool resolved, float noise) {
  const Force point = force_of_field(field, index);
  const Mask vertical = moves_vertically((Bits)field.status[index]);
  if (!resolved) resolved = recalled_normal(segment, past, index, noise, &judgement);
  if (resolved) {
    keep_for_next(past, index, judgement.normal, deviation_of(judgement));
  }
  const Force force = force_on_segment(point, vertical, judgement.normal);
  field.shear_x[index] = force.shear_x;
  field.shear_y[index] = force.shear_y;
  field.normal[index] = force.normal;
  if (resolved) field.status[index] |= PF_STATUS_FROM_NEIGHBOURS;
  if (field.magnitude != 0) {
    const Direction direction = direction_of(force);
    field.magnitude[index] = direction.magnitude;
    field.theta[index] = direction.theta;
    field.phi[index] = direction.phi;
  }
  if (field.deviation_normal == 0) return;
  write_ends(field, index, force_on_segment(point, vertical, judgement.low),
             force_on_segment(point, vertical, judgement.high));
  if (resolved) write_deviations(field, index, segment, vertical, judgement, noise);
}

/* Writes the forces of a contact's ambiguous pillars. */
static inline void write_contact(Tile tile, Cells cells, Field field, Past past, Verdict verdict,
                                 FieldSettings settings, Share share) {
  for (uint row = share.first; row < tile.rows; row += share.step) {
    for (uint col = 0; col < tile.cols; ++col) {
      const uint cell = cell_at(tile, row, col);
      if (cells.kind[cell] < PF_CELL_AMBIGUOUS) continue;
      const uint index = (tile.row + row) * field.cols + tile.col + col;
      const Segment segment = segment_of_cell(cells, cell);
      const Judgement judgement = judged_normal(
          segment, verdict, settings, verdict.way == PF_BY_SHAPE ? cells.shaped[cell] : 0.0f);
      write_judgement(field, past, index, segment, judgement, verdict.way > PF_BY_BOUND,
                      settings.noise);
    }
  }
}
