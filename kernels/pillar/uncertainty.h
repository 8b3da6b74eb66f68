/* Standard deviations of the components of `direct_force` from the noise of the sensels
 * (docs/derivations/uncertainty.md). */

/* Bounds of a pillar's force with saturated sensels (docs/derivations/uncertainty.md, U11, U12): a
 * saturated sensel bears its reading or more. */

PF_INLINE Mask any_saturated(Pillar pillar) {
  return pillar.s1.saturated || pillar.s2.saturated || pillar.s3.saturated || pillar.s4.saturated;
}

/* True if both sensels of a diagonal are usable, so that it measures the parity sum. */
PF_INLINE Mask both_usable(Sensel p, Sensel q) { return p.usable && q.usable; }

/* Half the range of V_p - V_q of a diagonal of two saturated sensels, counts (U12). */
PF_INLINE Real hidden_difference(Sensel p, Sensel q, Mask measured, Real sum) {
  const Real rest = sum - (p.reading + q.reading);
  return (measured && p.saturated && q.saturated && rest > PF_REAL(0.0)) ? rest : PF_REAL(0.0);
}

/* The components that saturated sensels leave without a bound, and half the range of the
 * differences over the diagonals, counts. */
typedef struct {
  Mask shear_x;
  Mask shear_y;
  Mask normal;
  Real difference;
} Open;

/* The components that the readings of a pillar with saturated sensels do not bound (U11, U12). */
PF_INLINE Open open_components(Pillar pillar, Diagonals diagonals, ParitySum sum) {
  const Sensel s1 = pillar.s1;
  const Sensel s2 = pillar.s2;
  const Sensel s3 = pillar.s3;
  const Sensel s4 = pillar.s4;
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Mask saturated = any_saturated(pillar);
  const Mask by_a = both_usable(s1, s3);
  const Mask by_b = both_usable(s2, s4);
  const Mask a_bounds = !(s1.saturated || s3.saturated || a.unbounded);
  const Mask b_bounds = !(s2.saturated || s4.saturated || b.unbounded);
  const Mask a_is_less = a.p + a.q <= b.p + b.q;
  const Mask bounded = sum.ambiguous && ((a_bounds && a_is_less) || (b_bounds && !a_is_less));
  const Mask both =
      (by_b && s1.saturated && s3.saturated) || (by_a && s2.saturated && s4.saturated);
  Open open;
  open.normal = saturated && !(by_a || by_b || bounded);
  open.shear_x = saturated && !(both || both_usable(s1, s2) || both_usable(s3, s4));
  open.shear_y = saturated && !(both || both_usable(s1, s4) || both_usable(s2, s3));
  open.difference =
      hidden_difference(s1, s3, by_b, sum.point) + hidden_difference(s2, s4, by_a, sum.point);
  return open;
}

/* Adds what saturated sensels leave open to the deviations of the components. */
PF_INLINE Force open_deviations(Force deviations, Open open, ForceScale scale) {
  const Real hidden = scale.shear * (PF_REAL(0.57735026918962576451) * open.difference);
  const Mask is_hidden = hidden > PF_REAL(0.0);
  if (any_lane(is_hidden)) { /* rare: two roots */
    const Real shear_x = plain_length_2(deviations.shear_x, hidden);
    const Real shear_y = plain_length_2(deviations.shear_y, hidden);
    deviations.shear_x = is_hidden ? shear_x : deviations.shear_x;
    deviations.shear_y = is_hidden ? shear_y : deviations.shear_y;
  }
  deviations.shear_x = open.shear_x ? PF_OPEN_N : deviations.shear_x;
  deviations.shear_y = open.shear_y ? PF_OPEN_N : deviations.shear_y;
  deviations.normal = open.normal ? PF_OPEN_N : deviations.normal;
  return deviations;
}

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
PF_INLINE ParityWeights parity_weights(Diagonals diagonals, Real segment_point) {
  const Real zero = PF_REAL(0.0);
  const Real one_half = PF_REAL(0.5);
  const Real one = PF_REAL(1.0);
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Mask determined = a.full || b.full;
  const Mask by_b = a.unbounded || ((a.p + a.q >= b.p + b.q) && !b.unbounded);
  const Mask has_a = a.full || !(determined || by_b);
  /* The weights add up to `whole` unless both diagonals are unbounded. */
  const Real point = has_segment(a, b) ? segment_point : one_half;
  const Real whole = determined ? one : point;
  const Real weight = (a.full && b.full) ? one_half : (has_a ? whole : zero);
  const Mask both_unbounded = a.unbounded && b.unbounded && !determined;
  const Real unbounded_weight =
      (one_measured(a) && one_measured(b)) ? PF_REAL(0.66666666666666666667) : one;
  ParityWeights weights;
  weights.rising = both_unbounded ? unbounded_weight : weight;
  weights.falling = both_unbounded ? unbounded_weight : whole - weight;
  return weights;
}

/* The linear form of `diagonal_difference` (U2). */
PF_INLINE DifferenceWeights difference_weights(Diagonal d) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  DifferenceWeights weights;
  weights.sum = (d.q_measured ? one : zero) - (d.p_measured ? one : zero);
  weights.p = d.p_measured ? one - weights.sum : zero;
  weights.q = d.q_measured ? -one - weights.sum : zero;
  return weights;
}

/* Variance of a reading, counts^2; zero for an inactive or missing sensel, a constant. */
PF_INLINE Real variance_of(Sensel sensel, Real noise) {
  return is_pressed(sensel) ? noise * noise : PF_REAL(0.0);
}

/* Root mean square distance of the true parity sum from the reported one, counts (U9): on a segment
 * by the distribution under friction, elsewhere by a uniform one over the interval. Zero where the
 * force is determined. */
PF_INLINE Real ambiguity_of(Pillar pillar, Diagonals diagonals, ParitySum sum, Real segment_point) {
  const Real away = segment_point - PF_REAL(0.875);
  const Real on_segment =
      any_saturated(pillar) ? PF_REAL(0.5) : plain_length_2(PF_REAL(0.12), away);
  const Mask segment = has_segment(diagonals.rising, diagonals.falling);
  const Real part = segment ? on_segment : PF_REAL(0.28867513459481288225);
  return sum.ambiguous ? part * sum.high : PF_REAL(0.0);
}

/* Deviations, N, from variances of the components and what ambiguity adds to them, counts. */
PF_INLINE Force roots_of(Force variances, Real to_x, Real to_y, Real ambiguity, ForceScale scale) {
  const Real square = ambiguity * ambiguity;
  Force deviations;
  deviations.shear_x = scale.shear * sqrt(variances.shear_x + to_x * to_x * square);
  deviations.shear_y = scale.shear * sqrt(variances.shear_y + to_y * to_y * square);
  deviations.normal = scale.normal * sqrt(variances.normal + square);
  return deviations;
}

/* Standard deviations of the components of `direct_force`, N (U3, U9), but for what saturated
 * sensels leave open; exact in regions 1 and 2. */
PF_INLINE Force force_deviations(Pillar pillar, Diagonals diagonals, ParitySum sum, Noise noise,
                                 Real segment_point, ForceScale scale) {
  const ParityWeights weights = parity_weights(diagonals, segment_point);
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
  const Force variances = {x1 * x1 * var1 + x2 * x2 * var2 + x3 * x3 * var3 + x4 * x4 * var4,
                           y1 * y1 * var1 + y2 * y2 * var2 + y3 * y3 * var3 + y4 * y4 * var4,
                           weights.rising * weights.rising * (var1 + var3) +
                               weights.falling * weights.falling * (var2 + var4)};
  const Real ambiguity = ambiguity_of(pillar, diagonals, sum, segment_point);
  if (!any_lane(ambiguity > PF_REAL(0x1p60))) {
    return roots_of(variances, to_x, to_y, ambiguity, scale);
  }
  const Scaling scaling = scaling_for(larger_of(ambiguity, PF_REAL(1.0)));
  const Real down = scaling.down;
  const Force scaled = {variances.shear_x * down * down, variances.shear_y * down * down,
                        variances.normal * down * down};
  Force deviations = roots_of(scaled, to_x, to_y, ambiguity * down, scale);
  deviations.shear_x = deviations.shear_x * scaling.up;
  deviations.shear_y = deviations.shear_y * scaling.up;
  deviations.normal = deviations.normal * scaling.up;
  return deviations;
}
