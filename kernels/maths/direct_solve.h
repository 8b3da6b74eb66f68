/* The force on one pillar from its four sensels, for all patterns of usable, lifted, missing and
 * saturated ones, without division or trigonometry (docs/derivations/direct_solve.md).
 *
 * The two diagonals 1-3 and 2-4 of a pillar measure the same thing, 2 k normal: the parity sum S.
 * A diagonal with both readings gives S; one with a single reading follows from S; where no
 * diagonal has both, S is only known to lie in an interval. The force is linear in what remains. */

/* The four sensels of a pillar. */
typedef struct {
  Sensel s1;
  Sensel s2;
  Sensel s3;
  Sensel s4;
} Pillar;

/* The readings of two opposite sensels, counts; one that is not known reads zero. */
typedef struct {
  Real p;
  Real q;
  Mask p_known;
  Mask q_known;
  Mask full;    /* p + q measures the parity sum */
  Mask missing; /* a sensel that tells nothing, not even that it is lifted */
} Diagonal;

typedef struct {
  Diagonal rising;  /* sensels 1 (upper right) and 3 (lower left) */
  Diagonal falling; /* sensels 2 (upper left) and 4 (lower right) */
} Diagonals;

/* The interval in which the parity sum lies, counts; a point where the force is determined. */
typedef struct {
  Real low;
  Real high;
} ParitySum;

/* 1 / (2 sqrt(2) k) and 1 / (2 k), newtons per count. */
typedef struct {
  Real shear;
  Real normal;
} ForceScale;

/* A saturated reading is a lower bound. It stands for the model's V only where parity, from the
 * sensel opposite and the other diagonal (`other_usable`), cannot replace it. */
static inline Diagonal make_diagonal(Sensel p, Sensel q, Mask other_usable) {
  Diagonal d;
  d.p_known = p.usable | (p.saturated & !(q.usable & other_usable));
  d.q_known = q.usable | (q.saturated & !(p.usable & other_usable));
  d.p = d.p_known ? p.reading : PF_REAL(0.0);
  d.q = d.q_known ? q.reading : PF_REAL(0.0);
  d.full = (p.usable & q.usable) | (d.p_known & d.q_known & !other_usable);
  d.missing = p.missing | q.missing;
  return d;
}

static inline Diagonals pillar_diagonals(Pillar pillar) {
  const Mask rising_usable = pillar.s1.usable & pillar.s3.usable;
  const Mask falling_usable = pillar.s2.usable & pillar.s4.usable;
  Diagonals diagonals;
  diagonals.rising = make_diagonal(pillar.s1, pillar.s3, falling_usable);
  diagonals.falling = make_diagonal(pillar.s2, pillar.s4, rising_usable);
  return diagonals;
}

/* Largest parity sum that a diagonal which is not full allows (D4): its reading where the other
 * sensel is lifted, twice that where the other is missing, any where it knows nothing. */
static inline Real parity_bound(Diagonal d) {
  const Real reading = d.p + d.q;
  const Real if_missing = (d.p_known | d.q_known) ? reading + reading : PF_REAL(1e38);
  return d.missing ? if_missing : reading;
}

/* The interval of the parity sum (D3, D4). */
static inline ParitySum parity_sum(Diagonals diagonals) {
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Real a_sum = a.p + a.q;
  const Real b_sum = b.p + b.q;
  const Real of_one = a.full ? a_sum : b_sum;
  const Real measured = (a.full & b.full) ? PF_REAL(0.5) * (a_sum + b_sum) : of_one;

  const Mask any_known = a.p_known | a.q_known | b.p_known | b.q_known;
  const Real a_bound = parity_bound(a);
  const Real b_bound = parity_bound(b);
  const Real least = a_bound < b_bound ? a_bound : b_bound;
  const Real bound = any_known ? least : PF_REAL(0.0);

  ParitySum sum;
  sum.low = (a.full | b.full) ? measured : PF_REAL(0.0);
  sum.high = (a.full | b.full) ? measured : bound;
  return sum;
}

/* V_p - V_q of a diagonal, an unknown reading being what parity leaves for it (D5). */
static inline Real diagonal_difference(Diagonal d, Real sum) {
  const Real p = d.p_known ? d.p : sum - d.q;
  const Real q = d.q_known ? d.q : sum - d.p;
  return p - q;
}

/* The force on a pillar whose parity sum is `sum` counts (D6). In region 3 every sum of the interval
 * gives a force that explains the readings: together they are the segment of possible forces. */
static inline Force force_at(Diagonals diagonals, Real sum, ForceScale scale) {
  const Real rising = diagonal_difference(diagonals.rising, sum);
  const Real falling = diagonal_difference(diagonals.falling, sum);
  Force force;
  force.shear_x = (rising - falling) * scale.shear;
  force.shear_y = (rising + falling) * scale.shear;
  force.normal = sum * scale.normal;
  return force;
}

/* The force on a pillar: the middle of the interval, which halves the worst error in region 3.
 * Regions 1 and 2: within 4 ULP of the magnitude, float or double. */
static inline Force direct_force(Diagonals diagonals, ParitySum sum, ForceScale scale) {
  return force_at(diagonals, PF_REAL(0.5) * (sum.low + sum.high), scale);
}

/* The status byte, bits 0 to 6. Opposite sensels usable while the other two are lifted contradict
 * the model and are inconsistent. */
static inline Bits direct_status(Pillar pillar, ParitySum sum) {
  const Bits none = PF_BITS(0);
  const Mask missing =
      pillar.s1.missing | pillar.s2.missing | pillar.s3.missing | pillar.s4.missing;
  const Mask saturated =
      pillar.s1.saturated | pillar.s2.saturated | pillar.s3.saturated | pillar.s4.saturated;
  const Mask rising_alone =
      pillar.s1.usable & pillar.s3.usable & is_lifted(pillar.s2) & is_lifted(pillar.s4);
  const Mask falling_alone =
      pillar.s2.usable & pillar.s4.usable & is_lifted(pillar.s1) & is_lifted(pillar.s3);
  Bits status = pillar.s1.usable ? PF_BITS(PF_STATUS_SENSEL_1) : none;
  status = status | (pillar.s2.usable ? PF_BITS(PF_STATUS_SENSEL_2) : none);
  status = status | (pillar.s3.usable ? PF_BITS(PF_STATUS_SENSEL_3) : none);
  status = status | (pillar.s4.usable ? PF_BITS(PF_STATUS_SENSEL_4) : none);
  status = status | (sum.low < sum.high ? PF_BITS(PF_STATUS_AMBIGUOUS) : none);
  status = status | (saturated ? PF_BITS(PF_STATUS_SATURATED) : none);
  status = status | ((missing | rising_alone | falling_alone) ? PF_BITS(PF_STATUS_INCONSISTENT)
                                                              : none);
  return status;
}

/* By how much `lifted`, opposite `usable`, should read above zero for parity to hold, counts (D8);
 * zero where the two are not so. */
static inline Real lifted_surplus(Sensel lifted, Sensel usable, Real sum) {
  return (is_lifted(lifted) & usable.usable) ? sum - usable.reading : PF_REAL(0.0);
}

/* Whether a redundant reading disagrees by more than `tolerance` counts: with four usable, the
 * parity residual (D7); with three, what the lifted one should read beyond `threshold` (D8). */
static inline Mask fails_parity(Pillar pillar, ParitySum sum, Real threshold, Real tolerance) {
  const Mask rising_usable = pillar.s1.usable & pillar.s3.usable;
  const Mask falling_usable = pillar.s2.usable & pillar.s4.usable;
  const Real residual = (pillar.s1.reading + pillar.s3.reading) -
                        (pillar.s2.reading + pillar.s4.reading);
  const Real surplus_1 = lifted_surplus(pillar.s1, pillar.s3, sum.high);
  const Real surplus_3 = lifted_surplus(pillar.s3, pillar.s1, sum.high);
  const Real surplus_2 = lifted_surplus(pillar.s2, pillar.s4, sum.high);
  const Real surplus_4 = lifted_surplus(pillar.s4, pillar.s2, sum.high);
  const Real allowed = threshold + tolerance;
  const Mask rising_fails = falling_usable & ((surplus_1 > allowed) | (surplus_3 > allowed));
  const Mask falling_fails = rising_usable & ((surplus_2 > allowed) | (surplus_4 > allowed));
  return (rising_usable & falling_usable & (fabs(residual) > tolerance)) | rising_fails |
         falling_fails;
}
