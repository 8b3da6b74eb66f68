/* The force on one pillar from its four sensels, for all patterns of usable, inactive, missing and
 * saturated ones, without division or trigonometry (docs/derivations/direct_solve.md).
 *
 * Both diagonals of a pillar, 1-3 and 2-4, measure the parity sum S = 2 k normal. A diagonal with
 * two readings gives S; the missing reading of one with a single reading follows from S; if neither
 * has two, S lies in an interval. The force is linear in S and in the differences over the
 * diagonals. It is consistent with the readings: V equals a usable reading, is at most the bound of
 * an inactive sensel and at least a saturated reading. */

/* The four sensels of a pillar, after `classify`. */
typedef struct {
  Sensel s1;
  Sensel s2;
  Sensel s3;
  Sensel s4;
} Pillar;

/* Standard deviations of the four readings, counts. */
typedef struct {
  Real n1;
  Real n2;
  Real n3;
  Real n4;
} Noise;

/* Two opposite sensels. A sensel is measured if the solve takes V to be its reading (D4). */
typedef struct {
  Counts p; /* readings, counts */
  Counts q;
  Mask p_measured;
  Mask q_measured;
  Mask full;      /* p + q measures the parity sum */
  Mask unbounded; /* a sensel is missing, so p + q does not bound the parity sum */
} Diagonal;

typedef struct {
  Diagonal rising;  /* sensels 1 (upper right) and 3 (lower left) */
  Diagonal falling; /* sensels 2 (upper left) and 4 (lower right) */
} Diagonals;

/* The interval in which the parity sum lies, counts; a point where the force is determined. */
typedef struct {
  Counts low;
  Counts high;
  Counts point;   /* the parity sum of the reported force (D10) */
  Mask ambiguous; /* low is below high */
} ParitySum;

/* 1 / (2 sqrt(2) k) and 1 / (2 k), newtons per count. */
typedef struct {
  Real shear;
  Real normal;
} ForceScale;

PF_INLINE Mask is_pressed(Sensel sensel) { return sensel.usable || sensel.saturated; }

PF_INLINE Mask both_pressed(Sensel p, Sensel q) { return is_pressed(p) && is_pressed(q); }

/* Measured sensels of a diagonal (D4): usable ones; saturated ones, whose reading is a lower bound,
 * unless the other diagonal's sum is larger (`more`) and determines them; and, on a pillar in
 * `contact`, inactive ones, whose reading is an upper bound, where nothing else divides the sum. */
PF_INLINE Diagonal make_diagonal(Sensel p, Sensel q, Mask more, Mask contact) {
  const Mask p_follows = p.saturated && more && (q.usable || is_inactive(q));
  const Mask q_follows = q.saturated && more && (p.usable || is_inactive(p));
  const Mask p_active = is_pressed(p) && !p_follows;
  const Mask q_active = is_pressed(q) && !q_follows;
  Diagonal d;
  d.p = p.reading;
  d.q = q.reading;
  d.p_measured = p_active || (contact && is_inactive(p) && (q.missing || q_follows));
  d.q_measured = q_active || (contact && is_inactive(q) && (p.missing || p_follows));
  d.full = p_active && q_active && !(more && p.saturated && q.saturated);
  d.unbounded = p.missing || q.missing;
  return d;
}

PF_INLINE Diagonals pillar_diagonals(Pillar pillar) {
  const Mask rising_pressed = both_pressed(pillar.s1, pillar.s3);
  const Mask falling_pressed = both_pressed(pillar.s2, pillar.s4);
  const Counts rising = pillar.s1.reading + pillar.s3.reading;
  const Counts falling = pillar.s2.reading + pillar.s4.reading;
  const Mask contact = is_pressed(pillar.s1) || is_pressed(pillar.s2) || is_pressed(pillar.s3) ||
                       is_pressed(pillar.s4);
  Diagonals diagonals;
  diagonals.rising =
      make_diagonal(pillar.s1, pillar.s3, falling_pressed && (falling > rising), contact);
  diagonals.falling =
      make_diagonal(pillar.s2, pillar.s4, rising_pressed && (rising > falling), contact);
  return diagonals;
}

PF_INLINE Mask one_measured(Diagonal d) { return d.p_measured || d.q_measured; }

/* Upper end of the parity interval where no diagonal is full, counts (D5): the smaller bound of the
 * diagonals without a missing sensel. If both have one, the interval is centred on the smallest
 * force that is consistent with the readings. Zero without contact. */
PF_INLINE Counts parity_bound(Diagonal a, Diagonal b) {
  const Counts a_sum = a.p + a.q;
  const Counts b_sum = b.p + b.q;
  const Counts least = a_sum < b_sum ? a_sum : b_sum;
  const Mask a_measured = one_measured(a);
  const Mask b_measured = one_measured(b);
#ifdef PF_WHOLE /* No sensel is missing. */
  const Counts bound = least;
#else
  const Counts closed = a.unbounded ? b_sum : (b.unbounded ? a_sum : least);
  const Real factor = (a_measured && b_measured) ? PF_REAL(1.33333333333333333333) : PF_REAL(2.0);
  const Counts bound = (a.unbounded && b.unbounded) ? factor * (a_sum + b_sum) : closed;
#endif
  return (a_measured || b_measured) ? bound : PF_COUNTS(0);
}

/* True if the forces form a segment whose upper end is a reading: a sensel of each diagonal is
 * measured, and a diagonal bounds the sum (D10). Requires that no diagonal is full. */
PF_INLINE Mask has_segment(Diagonal a, Diagonal b) {
#ifdef PF_WHOLE /* No sensel is missing. */
  return one_measured(a) && one_measured(b);
#else
  return one_measured(a) && one_measured(b) && !(a.unbounded && b.unbounded);
#endif
}

/* Parity sum: measured by one diagonal or as the mean of two (D1, D2), or the interval [0, bound]
 * (D5). The reported point is `segment_point` of the bound on a segment, its midpoint elsewhere
 * (D10). */
PF_INLINE ParitySum parity_sum(Diagonals diagonals, Fraction segment_point) {
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Counts a_sum = a.p + a.q;
  const Counts b_sum = b.p + b.q;
  const Counts mean = halved(a_sum + b_sum);
  const Counts measured = a.full ? (b.full ? mean : a_sum) : b_sum;
  const Mask determined = a.full || b.full;
  const Counts bound = parity_bound(a, b);
  ParitySum sum;
  sum.low = determined ? measured : PF_COUNTS(0);
  sum.high = determined ? measured : bound;
  const Counts point = has_segment(a, b) ? fraction_of(bound, segment_point) : halved(bound);
  sum.point = determined ? measured : point;
  sum.ambiguous = !determined && (bound > PF_COUNTS(0));
  return sum;
}

/* V_p and V_q of a diagonal whose parity sum is `sum`; parity gives the one that is not measured.
 * Requires that one of the two is. */
PF_INLINE Counts filled_p(Diagonal d, Counts sum) { return d.p_measured ? d.p : sum - d.q; }
PF_INLINE Counts filled_q(Diagonal d, Counts sum) { return d.q_measured ? d.q : sum - d.p; }

/* V_p - V_q of a diagonal whose parity sum is `sum` (D3); zero if neither sensel is measured. */
PF_INLINE Counts diagonal_difference(Diagonal d, Counts sum) {
  const Counts difference = filled_p(d, sum) - filled_q(d, sum);
  return one_measured(d) ? difference : PF_COUNTS(0);
}

/* The force on a pillar whose parity sum is `sum` counts (D6). In region 3 the sums of the interval
 * give the feasible segment: all forces that are consistent with the readings. */
PF_INLINE Force force_at(Diagonals diagonals, Counts sum, ForceScale scale) {
  const Counts rising = diagonal_difference(diagonals.rising, sum);
  const Counts falling = diagonal_difference(diagonals.falling, sum);
  Force force;
  force.shear_x = real_of(rising - falling) * scale.shear;
  force.shear_y = real_of(rising + falling) * scale.shear;
  force.normal = real_of(sum) * scale.normal;
  return force;
}

/* The force on a pillar, in region 3 at the segment point. Regions 1 and 2: within 4 ULP of the
 * magnitude, float or double. */
PF_INLINE Force direct_force(Diagonals diagonals, ParitySum sum, ForceScale scale) {
  return force_at(diagonals, sum.point, scale);
}

PF_INLINE Counts least_of(Counts a, Counts b) { return a < b ? a : b; }

#ifndef PF_WHOLE
PF_INLINE Real largest_reading(Pillar pillar) {
  const Real rising = pillar.s1.reading > pillar.s3.reading ? pillar.s1.reading : pillar.s3.reading;
  const Real falling =
      pillar.s2.reading > pillar.s4.reading ? pillar.s2.reading : pillar.s4.reading;
  return rising > falling ? rising : falling;
}
#endif

/* True if the inactive fourth sensel may carry load while three are usable: its upper bound is
 * above zero, and parity predicts more than -`margin` counts for it (D9). Usable sensels are above
 * zero, so the minimum over all four decides. */
PF_INLINE Mask fourth_may_be_loaded(Pillar pillar, Diagonals diagonals, Counts sum, Counts margin) {
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Counts least_filled = least_of(least_of(filled_p(a, sum), filled_q(a, sum)),
                                       least_of(filled_p(b, sum), filled_q(b, sum)));
  const Counts least_reading = least_of(least_of(pillar.s1.reading, pillar.s2.reading),
                                        least_of(pillar.s3.reading, pillar.s4.reading));
  return (least_filled > -margin) && (least_reading > PF_COUNTS(0));
}

/* The masks of a sensel as Bits. */
typedef struct {
  Bits usable;
  Bits saturated;
  Bits missing;
  Bits faulty; /* missing, but not absent */
  Bits inactive;
} State;

PF_INLINE State state_of(Sensel sensel) {
  State state;
  state.usable = bits_of(sensel.usable);
  state.saturated = bits_of(sensel.saturated);
  state.missing = bits_of(sensel.missing);
  state.faulty = bits_of(sensel.missing && !sensel.absent);
  state.inactive = ~(state.usable | state.saturated | state.missing);
  return state;
}

/* One of two opposite sensels is usable, the other inactive, as Bits. */
PF_INLINE Bits one_inactive_of(State p, State q) {
  return (p.usable & q.inactive) | (p.inactive & q.usable);
}

/* The status byte, bits 0 to 6. Ambiguous: the force is one of a segment, or the region is 1 or 2
 * within `margin` counts of parity. Inconsistent: a sensel is missing (an absent one only counts
 * where the pillar is in contact), or two opposite sensels are usable and the other two inactive,
 * which contradicts the model. */
PF_INLINE Bits direct_status(Pillar pillar, Diagonals diagonals, ParitySum sum, Counts margin) {
  const State s1 = state_of(pillar.s1);
  const State s2 = state_of(pillar.s2);
  const State s3 = state_of(pillar.s3);
  const State s4 = state_of(pillar.s4);
  const Bits rising = s1.usable & s3.usable;
  const Bits falling = s2.usable & s4.usable;
  const Bits three_usable =
      (rising & one_inactive_of(s2, s4)) | (falling & one_inactive_of(s1, s3));
  const Bits one_or_two =
      three_usable & bits_of(fourth_may_be_loaded(pillar, diagonals, sum.point, margin));
  const Bits ambiguous = bits_of(sum.ambiguous) | one_or_two;
  const Bits saturated = s1.saturated | s2.saturated | s3.saturated | s4.saturated;
  const Bits contact = s1.usable | s2.usable | s3.usable | s4.usable | saturated;
  const Bits missing = s1.missing | s2.missing | s3.missing | s4.missing;
  const Bits faulty = s1.faulty | s2.faulty | s3.faulty | s4.faulty;
  const Bits contradictory =
      (rising & s2.inactive & s4.inactive) | (falling & s1.inactive & s3.inactive);
  return (s1.usable & PF_BITS(PF_STATUS_SENSEL_1)) | (s2.usable & PF_BITS(PF_STATUS_SENSEL_2)) |
         (s3.usable & PF_BITS(PF_STATUS_SENSEL_3)) | (s4.usable & PF_BITS(PF_STATUS_SENSEL_4)) |
         (ambiguous & PF_BITS(PF_STATUS_AMBIGUOUS)) | (saturated & PF_BITS(PF_STATUS_SATURATED)) |
         ((faulty | (missing & contact) | contradictory) & PF_BITS(PF_STATUS_INCONSISTENT));
}

/* True if one of two opposite sensels is usable and the other inactive. */
PF_INLINE Mask one_inactive(Sensel p, Sensel q) {
  return (p.usable && is_inactive(q)) || (is_inactive(p) && q.usable);
}

/* True if a redundant reading disagrees by more than `tolerance` counts: with four usable, the
 * parity residual (D7); with three, the excess of the reading that parity predicts for the inactive
 * sensel over its upper bound (D8). */
PF_INLINE Mask fails_parity(Pillar pillar, ParitySum sum, Counts tolerance) {
  const Mask rising_usable = pillar.s1.usable && pillar.s3.usable;
  const Mask falling_usable = pillar.s2.usable && pillar.s4.usable;
  const Counts rising = pillar.s1.reading + pillar.s3.reading;
  const Counts falling = pillar.s2.reading + pillar.s4.reading;
  const Mask rising_predicted = falling_usable && one_inactive(pillar.s1, pillar.s3);
  const Mask falling_predicted = rising_usable && one_inactive(pillar.s2, pillar.s4);
  const Mask residual_fails = (rising - falling > tolerance) || (falling - rising > tolerance);
  return (rising_usable && falling_usable && residual_fails) ||
         (rising_predicted && (sum.high - rising > tolerance)) ||
         (falling_predicted && (sum.high - falling > tolerance));
}
