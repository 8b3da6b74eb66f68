/* Uncertainty of `direct_force`: standard deviations from the noise of the sensels, and intervals
 * of magnitude and direction for an ambiguous pillar (docs/derivations/uncertainty.md). */

/* What saturated sensels leave open of the force of a pillar (docs/derivations/uncertainty.md, U11,
 * U12): a saturated sensel bears its reading or more. */

static inline Mask any_saturated(Pillar pillar) {
  return pillar.s1.saturated || pillar.s2.saturated || pillar.s3.saturated || pillar.s4.saturated;
}

/* True if both sensels of a diagonal are usable, so that it measures the parity sum. */
static inline Mask both_usable(Sensel p, Sensel q) { return p.usable && q.usable; }

/* Half the range of V_p - V_q of a diagonal of two saturated sensels, counts (U12). */
static inline Real hidden_difference(Sensel p, Sensel q, Mask measured, Real sum) {
  const Real rest = sum - (p.reading + q.reading);
  return (measured && p.saturated && q.saturated && rest > PF_REAL(0.0)) ? rest : PF_REAL(0.0);
}

/* What saturated sensels leave open: components without a bound, and half the range of the
 * differences over the diagonals, counts. */
typedef struct {
  Mask shear_x;
  Mask shear_y;
  Mask normal;
  Real difference;
} Open;

/* The components that the readings of a pillar with saturated sensels do not bound (U11, U12). */
static inline Open open_components(Pillar pillar, Diagonals diagonals, ParitySum sum) {
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
static inline Force open_deviations(Force deviations, Open open, ForceScale scale) {
  const Real hidden = scale.shear * (PF_REAL(0.57735026918962576451) * open.difference);
  const Mask is_hidden = hidden > PF_REAL(0.0);
  const Real shear_x = is_hidden ? plain_length_2(deviations.shear_x, hidden) : deviations.shear_x;
  const Real shear_y = is_hidden ? plain_length_2(deviations.shear_y, hidden) : deviations.shear_y;
  deviations.shear_x = open.shear_x ? PF_INFINITY : shear_x;
  deviations.shear_y = open.shear_y ? PF_INFINITY : shear_y;
  deviations.normal = open.normal ? PF_INFINITY : deviations.normal;
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
static inline ParityWeights parity_weights(Diagonals diagonals, Real segment_point) {
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
static inline DifferenceWeights difference_weights(Diagonal d) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  DifferenceWeights weights;
  weights.sum = (d.q_measured ? one : zero) - (d.p_measured ? one : zero);
  weights.p = d.p_measured ? one - weights.sum : zero;
  weights.q = d.q_measured ? -one - weights.sum : zero;
  return weights;
}

/* Variance of a reading, counts^2; zero for an inactive or missing sensel, a constant. */
static inline Real variance_of(Sensel sensel, Real noise) {
  return is_pressed(sensel) ? noise * noise : PF_REAL(0.0);
}

/* Root mean square distance of the true parity sum from the reported one, counts (U9): on a segment
 * by the distribution under friction, elsewhere by a uniform one over the interval. Zero where the
 * force is determined. */
static inline Real ambiguity_of(Pillar pillar, Diagonals diagonals, ParitySum sum,
                                Real segment_point) {
  const Real away = segment_point - PF_REAL(0.875);
  const Real on_segment =
      any_saturated(pillar) ? PF_REAL(0.5) : plain_length_2(PF_REAL(0.12), away);
  const Mask segment = has_segment(diagonals.rising, diagonals.falling);
  const Real part = segment ? on_segment : PF_REAL(0.28867513459481288225);
  return sum.ambiguous ? part * sum.high : PF_REAL(0.0);
}

/* Deviations, N, from variances of the components and what ambiguity adds to them, counts. */
static inline Force roots_of(Force variances, Real to_x, Real to_y, Real ambiguity,
                             ForceScale scale) {
  const Real square = ambiguity * ambiguity;
  Force deviations;
  deviations.shear_x = scale.shear * sqrt(variances.shear_x + to_x * to_x * square);
  deviations.shear_y = scale.shear * sqrt(variances.shear_y + to_y * to_y * square);
  deviations.normal = scale.normal * sqrt(variances.normal + square);
  return deviations;
}

/* Standard deviations of the components of the force of readings, N (U3, U9); exact in regions 1
 * and 2. */
static inline Force reading_deviations(Pillar pillar, Diagonals diagonals, ParitySum sum,
                                       Noise noise, Real segment_point, ForceScale scale) {
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

/* Standard deviations of the components of `direct_force`, N: those of its readings, infinite where
 * a saturated sensel leaves a component open. */
static inline Force force_deviations(Pillar pillar, Diagonals diagonals, ParitySum sum, Noise noise,
                                     Real segment_point, ForceScale scale) {
  const Force deviations = reading_deviations(pillar, diagonals, sum, noise, segment_point, scale);
  if (!any_lane(any_saturated(pillar))) return deviations;
  return open_deviations(deviations, open_components(pillar, diagonals, sum), scale);
}

/* Intervals of magnitude and direction without noise. phi runs counter-clockwise from phi_low to
 * phi_high, which is below phi_low where the interval crosses pi. */
typedef struct {
  Real theta_low; /* rad */
  Real theta_high;
  Real phi_low;
  Real phi_high;
  Real magnitude_low; /* N */
  Real magnitude_high;
} DirectionInterval;

/* True if parity does not divide the sum between the two sensels of a diagonal. */
static inline Mask is_unconstrained(Sensel p, Sensel q) { return is_inactive(p) && is_inactive(q); }

/* True if the parity sum is a point and neither diagonal is unconstrained. */
static inline Mask is_determined(Pillar pillar, ParitySum sum) {
  return !(sum.ambiguous || is_unconstrained(pillar.s1, pillar.s3) ||
           is_unconstrained(pillar.s2, pillar.s4));
}

/* The interval of a determined pillar: both ends are the estimate. */
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

static inline DirectionInterval either_interval(Mask condition, DirectionInterval a,
                                                DirectionInterval b) {
  DirectionInterval interval;
  interval.theta_low = condition ? a.theta_low : b.theta_low;
  interval.theta_high = condition ? a.theta_high : b.theta_high;
  interval.phi_low = condition ? a.phi_low : b.phi_low;
  interval.phi_high = condition ? a.phi_high : b.phi_high;
  interval.magnitude_low = condition ? a.magnitude_low : b.magnitude_low;
  interval.magnitude_high = condition ? a.magnitude_high : b.magnitude_high;
  return interval;
}

/* Readings and parity interval of a pillar, scaled against overflow and underflow, counts. */
typedef struct {
  Diagonal a; /* rising */
  Diagonal b; /* falling */
  Mask a_unconstrained;
  Mask b_unconstrained;
  Real low;     /* ends of the parity sum */
  Real high;    /* the smaller bound if both diagonals are unconstrained (U4) */
  Real largest; /* reading */
  Real newtons; /* per count */
} ScaledPillar;

static inline ScaledPillar scaled_pillar(Pillar pillar, Diagonals diagonals, ParitySum sum,
                                         Real newtons) {
  ScaledPillar e;
  e.a = diagonals.rising;
  e.b = diagonals.falling;
  e.a_unconstrained = is_unconstrained(pillar.s1, pillar.s3);
  e.b_unconstrained = is_unconstrained(pillar.s2, pillar.s4);
  e.low = sum.low;
  e.high =
      (e.a_unconstrained && e.b_unconstrained) ? least_of(e.a.p + e.a.q, e.b.p + e.b.q) : sum.high;
  e.largest = larger_of(larger_of(e.a.p, e.a.q), larger_of(e.b.p, e.b.q));
  e.newtons = newtons;
  if (needs_scaling(e.largest)) {
    const Scaling scaling = scaling_for(e.largest);
    e.a.p = e.a.p * scaling.down;
    e.a.q = e.a.q * scaling.down;
    e.b.p = e.b.p * scaling.down;
    e.b.q = e.b.q * scaling.down;
    e.low = e.low * scaling.down;
    e.high = e.high * scaling.down;
    e.newtons = e.newtons * scaling.up;
  }
  return e;
}

/* V_p - V_q of a diagonal, linear in the parity sum: base - slope * sum (D3). */
typedef struct {
  Real base;
  Real slope; /* 1 if p alone is measured, -1 if q alone is, else 0 */
} DifferenceLine;

static inline DifferenceLine difference_line(Diagonal d) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real level = (d.p_measured ? d.p : zero) - (d.q_measured ? d.q : zero);
  DifferenceLine line;
  line.slope = (d.p_measured ? one : zero) - (d.q_measured ? one : zero);
  line.base = level + line.slope * line.slope * level;
  return line;
}

static inline Real difference_at(DifferenceLine line, Real sum) {
  return line.base - line.slope * sum;
}

/* Largest difference of two inactive sensels in one direction (U5). */
static inline Real most_difference(Real reading, Real sum) {
  return larger_of((reading + reading) - sum, PF_REAL(0.0));
}

/* 1 / c_x and 1 / c_y of the shear coefficient (E2). */
typedef struct {
  Real x;
  Real y;
  bool are_one; /* both, for shorter formulas */
} ShearWeights;

/* Squared shear with these differences over the diagonals, counts^2. */
static inline Real shear_square(Real a, Real b, ShearWeights weights) {
  if (weights.are_one) return a * a + b * b;
  const Real x = weights.x * (a - b);
  const Real y = weights.y * (a + b);
  return PF_REAL(0.5) * (x * x + y * y);
}

/* Ends of the difference of a diagonal at the smallest parity sum: -low .. high if it is
 * unconstrained (U5), else both its value there. */
typedef struct {
  Real low;
  Real high;
} DifferenceEnds;

static inline DifferenceEnds ends_of(Diagonal d, Mask unconstrained, Real flat, Real sum) {
  DifferenceEnds ends;
  ends.low = unconstrained ? most_difference(d.q, sum) : flat;
  ends.high = unconstrained ? most_difference(d.p, sum) : flat;
  return ends;
}

/* Squared shear of the longest force, counts^2: the force at the smallest parity sum. */
static inline Real longest_shear(ScaledPillar e, DifferenceEnds a_ends, DifferenceEnds b_ends,
                                 ShearWeights weights) {
  const Real a = larger_of(a_ends.low, a_ends.high);
  const Real b = larger_of(b_ends.low, b_ends.high);
  const Real longest = shear_square(a, b, weights);
  if (weights.are_one) return longest;
  const Real turned = shear_square(a, -b, weights);
  return (e.a_unconstrained || e.b_unconstrained) ? larger_of(longest, turned) : longest;
}

/* The largest |phi| of a pillar without measured sensels, rad. */
static inline Real largest_phi_of(ScaledPillar e) {
  return e.high > PF_REAL(0.0) ? PF_REAL(3.14159265358979323846) : PF_REAL(0.0);
}

/* The interval of a pillar without measured sensels, up to the bounds of its inactive ones (U8). */
static inline DirectionInterval inactive_interval(ScaledPillar e, ShearWeights weights) {
  const Real zero = PF_REAL(0.0);
  const Real largest_phi = largest_phi_of(e);
  DirectionInterval interval;
  interval.theta_low = zero;
  interval.theta_high = e.high > zero ? PF_REAL(1.57079632679489661923) : zero;
  interval.phi_low = zero - largest_phi;
  interval.phi_high = largest_phi;
  interval.magnitude_low = zero;
  const DifferenceEnds a = ends_of(e.a, e.a_unconstrained, zero, e.low);
  const DifferenceEnds b = ends_of(e.b, e.b_unconstrained, zero, e.low);
  interval.magnitude_high = e.newtons * sqrt(longest_shear(e, a, b, weights));
  return interval;
}

/* phi of the shear with these differences over the diagonals (M2, M5); zero without shear. */
static inline Real phi_of(Real rising, Real falling, ShearWeights weights) {
  return angle_of(PF_REAL(0.0) - weights.y * (rising + falling), weights.x * (falling - rising));
}

/* An interval in the plane, counter-clockwise. */
typedef struct {
  Real low;
  Real high;
} PhiInterval;

/* The shorter interval between two directions of shear (U7). */
static inline PhiInterval phi_between(Real a_from, Real b_from, Real a_to, Real b_to,
                                      ShearWeights weights) {
  const Mask clockwise = a_from * b_to < b_from * a_to;
  const Real from = phi_of(a_from, b_from, weights);
  const Real to = phi_of(a_to, b_to, weights);
  PhiInterval phi;
  phi.low = clockwise ? to : from;
  phi.high = clockwise ? from : to;
  return phi;
}

/* phi between the ends of a segment, or of an unconstrained diagonal at the smallest sum. */
static inline PhiInterval phi_interval(ScaledPillar e, DifferenceEnds a, DifferenceEnds b,
                                       Real a_steep, Real b_steep, ShearWeights weights) {
  const Mask unconstrained = e.a_unconstrained || e.b_unconstrained;
  const Real a_from = e.a_unconstrained ? -a.low : a.low;
  const Real b_from = e.b_unconstrained ? -b.low : b.low;
  const Real a_to = unconstrained ? a.high : a_steep;
  const Real b_to = unconstrained ? b.high : b_steep;
  return phi_between(a_from, b_from, a_to, b_to, weights);
}

/* The parity sum of the shortest force (U6). */
static inline Real shortest_sum(ScaledPillar e, DifferenceLine a, DifferenceLine b,
                                ShearWeights weights) {
  const Real one_half = PF_REAL(0.5);
  Real free;
  if (weights.are_one) {
    const Mask both = a.slope != PF_REAL(0.0) && b.slope != PF_REAL(0.0);
    free =
        (both ? PF_REAL(0.33333333333333333333) : one_half) * (a.slope * a.base + b.slope * b.base);
  } else {
    const Real x = one_half * weights.x * weights.x;
    const Real y = one_half * weights.y * weights.y;
    const Real x_slope = a.slope - b.slope;
    const Real y_slope = a.slope + b.slope;
    const Real pull = x * x_slope * (a.base - b.base) + y * y_slope * (a.base + b.base);
    free = pull / (x * x_slope * x_slope + y * y_slope * y_slope + PF_REAL(1.0));
  }
  return free < e.low ? e.low : least_of(free, e.high);
}

/* The interval of a pillar whose force is not determined; `inactive` are those of U8. */
static inline DirectionInterval ambiguous_interval(ScaledPillar e, Mask inactive,
                                                   Direction estimate, ShearWeights weights) {
  const Real zero = PF_REAL(0.0);
  const Real quarter_turn = PF_REAL(1.57079632679489661923);
  const DifferenceLine a = difference_line(e.a);
  const DifferenceLine b = difference_line(e.b);
  const DifferenceEnds a_ends = ends_of(e.a, e.a_unconstrained, difference_at(a, e.low), e.low);
  const DifferenceEnds b_ends = ends_of(e.b, e.b_unconstrained, difference_at(b, e.low), e.low);
  const Real a_steep = difference_at(a, e.high);
  const Real b_steep = difference_at(b, e.high);
  const Real least = shortest_sum(e, a, b, weights);
  const Real flat = longest_shear(e, a_ends, b_ends, weights);
  const Real shortest =
      shear_square(difference_at(a, least), difference_at(b, least), weights) + least * least;

  /* Either the parity sum begins at zero, where the force lies in the plane, or it is measured, and
   * the estimate is the steepest force. */
  const Mask from_zero = !(e.low > zero);
  const Real slope = sqrt(from_zero ? shear_square(a_steep, b_steep, weights) : flat);
  const Real tilt = acute_angle_of(slope, e.high);
  const PhiInterval phi = phi_interval(e, a_ends, b_ends, a_steep, b_steep, weights);
  const Real largest_phi = largest_phi_of(e);
  DirectionInterval interval;
  interval.theta_low = from_zero ? tilt : estimate.theta;
  interval.theta_high = from_zero ? (flat > zero ? quarter_turn : zero) : tilt;
  interval.phi_low = inactive ? zero - largest_phi : phi.low;
  interval.phi_high = inactive ? largest_phi : phi.high;
  interval.magnitude_low = e.newtons * sqrt(shortest);
  interval.magnitude_high = e.newtons * sqrt(flat + e.low * e.low);
  return interval;
}

/* The interval of a pillar without missing and saturated sensels (U4 to U8).
 *
 * The general interval costs more than the rest of the solve; cheaper formulas give the same bits
 * where no lane needs it. */
static inline DirectionInterval interval_of_readings(Pillar pillar, Diagonals diagonals,
                                                     ParitySum sum, Direction estimate,
                                                     ForceScale scale, ShearWeights weights) {
  const Mask determined = is_determined(pillar, sum);
  const DirectionInterval point = point_interval(estimate);
  if (!any_lane(!determined)) return point;
  const ScaledPillar e = scaled_pillar(pillar, diagonals, sum, scale.normal);
  const Mask inactive = e.a_unconstrained && e.b_unconstrained &&
                        (e.high > PF_REAL(0.0) || !(e.largest > PF_REAL(0.0)));
  if (!any_lane(!(determined || inactive))) {
    return either_interval(determined, point, inactive_interval(e, weights));
  }
  return either_interval(determined, point, ambiguous_interval(e, inactive, estimate, weights));
}

/* The interval of a pillar with saturated sensels whose force is open: any direction, and a
 * magnitude of at least that of `interval` (U12). */
static inline DirectionInterval open_interval(DirectionInterval interval, Open open) {
  const Real pi = PF_REAL(3.14159265358979323846);
  DirectionInterval any;
  any.theta_low = PF_REAL(0.0);
  any.theta_high = PF_REAL(1.57079632679489661923);
  any.phi_low = -pi;
  any.phi_high = pi;
  any.magnitude_low = interval.magnitude_low;
  any.magnitude_high = PF_INFINITY;
  const Mask is_open =
      open.shear_x || open.shear_y || open.normal || open.difference > PF_REAL(0.0);
  return either_interval(is_open, any, interval);
}

/* Intervals of theta, phi and magnitude over all forces that are consistent with the readings of a
 * pillar without missing sensels (U4 to U8, U12). Both ends are the estimate where the force is
 * determined. `sum` comes from `parity_sum`, `estimate` is the direction of `direct_force`. */
static inline DirectionInterval direction_interval(Pillar pillar, Diagonals diagonals,
                                                   ParitySum sum, Direction estimate,
                                                   ForceScale scale, ShearWeights weights) {
  const DirectionInterval interval =
      interval_of_readings(pillar, diagonals, sum, estimate, scale, weights);
  if (!any_lane(any_saturated(pillar))) return interval;
  return open_interval(interval, open_components(pillar, diagonals, sum));
}
