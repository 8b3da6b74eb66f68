/* What a pillar's readings leave open: the standard deviations that the noise of the sensels gives
 * the estimated force, and the ends of what an ambiguous pillar may be
 * (docs/derivations/uncertainty.md). For `direct_force`. */

/* Standard deviations of the four readings, counts. */
typedef struct {
  Real n1;
  Real n2;
  Real n3;
  Real n4;
} Noise;

/* Weights of the sums p + q of both diagonals in the estimated parity sum. */
typedef struct {
  Real rising;
  Real falling;
} ParityWeights;

/* V_p - V_q of a diagonal as p * reading + q * reading + sum * S. */
typedef struct {
  Real p;
  Real q;
  Real sum;
} DifferenceWeights;

/* The parity sum of `direct_force` is linear in the readings, with these weights (U1). */
static inline ParityWeights parity_weights(Diagonals diagonals) {
  const Real zero = PF_REAL(0.0);
  const Real one_half = PF_REAL(0.5);
  const Real one = PF_REAL(1.0);
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Mask a_stands = a.p_stands || a.q_stands;
  const Mask b_stands = b.p_stands || b.q_stands;
  const Mask by_b = a.open || ((a.p + a.q >= b.p + b.q) && !b.open);
  const Real share = (a_stands && b_stands) ? PF_REAL(0.66666666666666666667) : one;
  const Real open_a = (a.open && b.open) ? share : (by_b ? zero : one_half);
  const Real open_b = (a.open && b.open) ? share : (by_b ? one_half : zero);
  ParityWeights weights;
  weights.rising = a.full ? (b.full ? one_half : one) : (b.full ? zero : open_a);
  weights.falling = b.full ? (a.full ? one_half : one) : (a.full ? zero : open_b);
  return weights;
}

/* The linear form of `diagonal_difference` (U2). */
static inline DifferenceWeights difference_weights(Diagonal d) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real two = PF_REAL(2.0);
  const Mask both = d.p_stands && d.q_stands;
  DifferenceWeights weights;
  weights.p = both ? one : (d.p_stands ? two : zero);
  weights.q = both ? -one : (d.q_stands ? -two : zero);
  weights.sum = both ? zero : (d.p_stands ? -one : (d.q_stands ? one : zero));
  return weights;
}

/* A lifted or missing sensel enters the estimate with a constant, which has no noise. */
static inline Real variance_of(Sensel sensel, Real noise) {
  return is_pressed(sensel) ? noise * noise : PF_REAL(0.0);
}

/* Standard deviations of the components of `direct_force`, N (U3). In regions 1 and 2 they are
 * exact; in region 3 they are those of the middle of the segment, whose length is not in them. */
static inline Force force_deviations(Pillar pillar, Diagonals diagonals, Noise noise,
                                     ForceScale scale) {
  const ParityWeights weights = parity_weights(diagonals);
  const DifferenceWeights rising = difference_weights(diagonals.rising);
  const DifferenceWeights falling = difference_weights(diagonals.falling);
  const Real to_x = rising.sum - falling.sum;
  const Real to_y = rising.sum + falling.sum;
  const Real x1 = rising.p + to_x * weights.rising;
  const Real x3 = rising.q + to_x * weights.rising;
  const Real x2 = to_x * weights.falling - falling.p;
  const Real x4 = to_x * weights.falling - falling.q;
  const Real y1 = rising.p + to_y * weights.rising;
  const Real y3 = rising.q + to_y * weights.rising;
  const Real y2 = falling.p + to_y * weights.falling;
  const Real y4 = falling.q + to_y * weights.falling;
  const Real var1 = variance_of(pillar.s1, noise.n1);
  const Real var2 = variance_of(pillar.s2, noise.n2);
  const Real var3 = variance_of(pillar.s3, noise.n3);
  const Real var4 = variance_of(pillar.s4, noise.n4);
  const Real rising_share = weights.rising * weights.rising * (var1 + var3);
  const Real falling_share = weights.falling * weights.falling * (var2 + var4);
  Force deviations;
  deviations.shear_x =
      scale.shear * sqrt(x1 * x1 * var1 + x2 * x2 * var2 + x3 * x3 * var3 + x4 * x4 * var4);
  deviations.shear_y =
      scale.shear * sqrt(y1 * y1 * var1 + y2 * y2 * var2 + y3 * y3 * var3 + y4 * y4 * var4);
  deviations.normal = scale.normal * sqrt(rising_share + falling_share);
  return deviations;
}

/* What magnitude and direction may be, noise apart. Angles in the plane run counter-clockwise from
 * phi_low to phi_high, which is below it where that passes pi. */
typedef struct {
  Real theta_low; /* rad */
  Real theta_high;
  Real phi_low;
  Real phi_high;
  Real magnitude_low; /* N */
  Real magnitude_high;
} DirectionInterval;

/* What V_p - V_q may be at a given parity sum. Two lifted sensels share it as their silence lets
 * them (U5), with zero where the estimate is. */
typedef struct {
  Real low;
  Real high;
} DifferenceInterval;

static inline DifferenceInterval difference_interval(Diagonal d, Mask loose, Real sum) {
  const Real zero = PF_REAL(0.0);
  const Real difference = diagonal_difference(d, sum);
  const Real low = sum - (d.q + d.q);
  const Real high = (d.p + d.p) - sum;
  DifferenceInterval interval;
  interval.low = loose ? (low < zero ? low : zero) : difference;
  interval.high = loose ? (high > zero ? high : zero) : difference;
  return interval;
}

static inline Real larger_side(DifferenceInterval interval) {
  return -interval.low > interval.high ? -interval.low : interval.high;
}

/* phi of the shear whose differences are these (M2, M5); zero without shear. */
static inline Real phi_of(Real rising, Real falling) {
  return angle_of(PF_REAL(0.0) - (rising + falling), falling - rising);
}

static inline Diagonal scaled(Diagonal d, Real factor) {
  d.p = d.p * factor;
  d.q = d.q * factor;
  return d;
}

/* Whether both ends are the estimate: the parity sum is a point, and no two lifted sensels share
 * it.
 */
static inline Mask is_settled(Pillar pillar, ParitySum sum) {
  const Mask a_loose = is_lifted(pillar.s1) && is_lifted(pillar.s3);
  const Mask b_loose = is_lifted(pillar.s2) && is_lifted(pillar.s4);
  return !(sum.ambiguous || a_loose || b_loose);
}

/* The interval about a settled estimate. */
static inline DirectionInterval point_interval(Direction estimate) {
  DirectionInterval interval;
  interval.theta_low = estimate.theta;
  interval.theta_high = estimate.theta;
  interval.phi_low = estimate.phi;
  interval.phi_high = estimate.phi;
  interval.magnitude_low = estimate.magnitude;
  interval.magnitude_high = estimate.magnitude;
  return interval;
}

/* The ends of theta, phi and magnitude over all forces that explain the readings of a pillar
 * without missing and saturated sensels (U4 to U8). Both ends are the estimate where the force is
 * determined. `sum` is that of `parity_sum`, `estimate` the direction of `direct_force`. */
static inline DirectionInterval direction_interval(Pillar pillar, Diagonals diagonals,
                                                   ParitySum sum, Direction estimate,
                                                   ForceScale scale) {
  const Real zero = PF_REAL(0.0);
  const Real pi = PF_REAL(3.14159265358979323846);
  const Real quarter_turn = PF_REAL(1.57079632679489661923);
  const Mask a_loose = is_lifted(pillar.s1) && is_lifted(pillar.s3);
  const Mask b_loose = is_lifted(pillar.s2) && is_lifted(pillar.s4);
  const Mask silent = a_loose && b_loose;

  /* Counts, scaled so that no product overflows or vanishes. */
  const Scaling scaling =
      scaling_for(larger_of(larger_of(diagonals.rising.p, diagonals.rising.q),
                            larger_of(diagonals.falling.p, diagonals.falling.q)));
  const Diagonal a = scaled(diagonals.rising, scaling.down);
  const Diagonal b = scaled(diagonals.falling, scaling.down);
  const Real low = sum.low * scaling.down;
  const Real most = silent ? least_of(a.p + a.q, b.p + b.q) : sum.high * scaling.down;

  /* At the least parity sum the force is longest, flattest and, if it may turn, freest. */
  const DifferenceInterval a_flat = difference_interval(a, a_loose, low);
  const DifferenceInterval b_flat = difference_interval(b, b_loose, low);
  const Real a_side = larger_side(a_flat);
  const Real b_side = larger_side(b_flat);
  const Real a_steep = diagonal_difference(a, most);
  const Real b_steep = diagonal_difference(b, most);

  /* Where the force is shortest (U6). */
  const Mask a_sloped = a.p_stands != a.q_stands;
  const Mask b_sloped = b.p_stands != b.q_stands;
  const Real a_reading = a_sloped ? (a.p_stands ? a.p : a.q) : zero;
  const Real b_reading = b_sloped ? (b.p_stands ? b.p : b.q) : zero;
  const Real share = (a_sloped && b_sloped) ? PF_REAL(0.66666666666666666667) : PF_REAL(1.0);
  const Real free = share * (a_reading + b_reading);
  const Real least = free < low ? low : (free > most ? most : free);
  const Real a_short = diagonal_difference(a, least);
  const Real b_short = diagonal_difference(b, least);

  /* Either the parity sum begins at zero, where the force lies in the plane; or it is known, and
   * the estimate is the steepest force. */
  const Mask from_zero = !(low > zero);
  const Real slope = plain_length_2(from_zero ? a_steep : a_side, from_zero ? b_steep : b_side);
  const Real tilt = angle_of(slope, from_zero ? most : low);
  const Real in_plane = (a_side > zero || b_side > zero) ? quarter_turn : zero;

  /* Two corners between which the shear turns, and which way. */
  const Mask loose = a_loose || b_loose;
  const Real a_from = a_loose ? a_flat.low : a_flat.high;
  const Real b_from = b_loose ? b_flat.low : b_flat.high;
  const Real a_to = loose ? a_flat.high : a_steep;
  const Real b_to = loose ? b_flat.high : b_steep;
  const Mask clockwise = a_from * b_to < b_from * a_to;
  const Real phi_from = phi_of(a_from, b_from);
  const Real phi_to = phi_of(a_to, b_to);
  const Mask any_phi = silent && (most > zero);
  const Real phi_low = any_phi ? -pi : (clockwise ? phi_to : phi_from);
  const Real phi_high = any_phi ? pi : (clockwise ? phi_from : phi_to);

  const Real newtons = scale.normal * scaling.up;
  const Real magnitude_low = newtons * plain_length_3(a_short, b_short, least);
  const Real magnitude_high = newtons * plain_length_3(a_side, b_side, low);
  const Mask settled = is_settled(pillar, sum);
  DirectionInterval interval;
  interval.theta_low = (settled || !from_zero) ? estimate.theta : tilt;
  interval.theta_high = settled ? estimate.theta : (from_zero ? in_plane : tilt);
  interval.phi_low = settled ? estimate.phi : phi_low;
  interval.phi_high = settled ? estimate.phi : phi_high;
  interval.magnitude_low = settled ? estimate.magnitude : magnitude_low;
  interval.magnitude_high = settled ? estimate.magnitude : magnitude_high;
  return interval;
}
