/* Intervals of magnitude and direction of `direct_force` for an ambiguous pillar
 * (docs/derivations/uncertainty.md). */

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
PF_INLINE Mask is_unconstrained(Sensel p, Sensel q) { return is_inactive(p) && is_inactive(q); }

/* True if the parity sum is a point and neither diagonal is unconstrained. */
PF_INLINE Mask is_determined(Pillar pillar, ParitySum sum) {
  return !(sum.ambiguous || is_unconstrained(pillar.s1, pillar.s3) ||
           is_unconstrained(pillar.s2, pillar.s4));
}

/* The interval of a determined pillar: both ends are the estimate. */
PF_INLINE DirectionInterval point_interval(Direction estimate) {
  DirectionInterval interval;
  interval.theta_low = estimate.theta;
  interval.theta_high = estimate.theta;
  interval.phi_low = estimate.phi;
  interval.phi_high = estimate.phi;
  interval.magnitude_low = estimate.magnitude;
  interval.magnitude_high = estimate.magnitude;
  return interval;
}

PF_INLINE DirectionInterval either_interval(Mask condition, DirectionInterval a,
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

PF_INLINE ScaledPillar scaled_pillar(Pillar pillar, Diagonals diagonals, ParitySum sum,
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

PF_INLINE DifferenceLine difference_line(Diagonal d) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real level = (d.p_measured ? d.p : zero) - (d.q_measured ? d.q : zero);
  DifferenceLine line;
  line.slope = (d.p_measured ? one : zero) - (d.q_measured ? one : zero);
  line.base = level + line.slope * line.slope * level;
  return line;
}

PF_INLINE Real difference_at(DifferenceLine line, Real sum) { return line.base - line.slope * sum; }

/* Largest difference of two inactive sensels in one direction (U5). */
PF_INLINE Real most_difference(Real reading, Real sum) {
  return larger_of((reading + reading) - sum, PF_REAL(0.0));
}

/* 1 / c_x and 1 / c_y of the shear coefficient (E2). */
typedef struct {
  Real x;
  Real y;
  bool are_one; /* both, for shorter formulas */
} ShearWeights;

/* Squared shear with these differences over the diagonals, counts^2. */
PF_INLINE Real shear_square(Real a, Real b, ShearWeights weights) {
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

PF_INLINE DifferenceEnds ends_of(Diagonal d, Mask unconstrained, Real flat, Real sum) {
  DifferenceEnds ends;
  ends.low = unconstrained ? most_difference(d.q, sum) : flat;
  ends.high = unconstrained ? most_difference(d.p, sum) : flat;
  return ends;
}

/* Squared shear of the longest force, counts^2: the force at the smallest parity sum. */
PF_INLINE Real longest_shear(ScaledPillar e, DifferenceEnds a_ends, DifferenceEnds b_ends,
                             ShearWeights weights) {
  const Real a = larger_of(a_ends.low, a_ends.high);
  const Real b = larger_of(b_ends.low, b_ends.high);
  const Real longest = shear_square(a, b, weights);
  if (weights.are_one) return longest;
  const Real turned = shear_square(a, -b, weights);
  return (e.a_unconstrained || e.b_unconstrained) ? larger_of(longest, turned) : longest;
}

/* The largest |phi| of a pillar without measured sensels, rad. */
PF_INLINE Real largest_phi_of(ScaledPillar e) {
  return e.high > PF_REAL(0.0) ? PF_REAL(3.14159265358979323846) : PF_REAL(0.0);
}

/* The interval of a pillar without measured sensels, up to the bounds of its inactive ones (U8). */
PF_INLINE DirectionInterval inactive_interval(ScaledPillar e, ShearWeights weights) {
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
PF_INLINE Real phi_of(Real rising, Real falling, ShearWeights weights) {
  return angle_of(PF_REAL(0.0) - weights.y * (rising + falling), weights.x * (falling - rising));
}

/* An interval in the plane, counter-clockwise. */
typedef struct {
  Real low;
  Real high;
} PhiInterval;

/* The shorter interval between two directions of shear (U7). */
PF_INLINE PhiInterval phi_between(Real a_from, Real b_from, Real a_to, Real b_to,
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
PF_INLINE PhiInterval phi_interval(ScaledPillar e, DifferenceEnds a, DifferenceEnds b, Real a_steep,
                                   Real b_steep, ShearWeights weights) {
  const Mask unconstrained = e.a_unconstrained || e.b_unconstrained;
  const Real a_from = e.a_unconstrained ? -a.low : a.low;
  const Real b_from = e.b_unconstrained ? -b.low : b.low;
  const Real a_to = unconstrained ? a.high : a_steep;
  const Real b_to = unconstrained ? b.high : b_steep;
  return phi_between(a_from, b_from, a_to, b_to, weights);
}

/* The parity sum of the shortest force (U6). */
PF_INLINE Real shortest_sum(ScaledPillar e, DifferenceLine a, DifferenceLine b,
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
PF_INLINE DirectionInterval ambiguous_interval(ScaledPillar e, Mask inactive, Direction estimate,
                                               ShearWeights weights) {
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

/* Intervals of theta, phi and magnitude over all forces that are consistent with the readings of a
 * pillar without missing and saturated sensels (U4 to U8). Both ends are the estimate where the
 * force is determined. `sum` comes from `parity_sum`, `estimate` is the direction of
 * `direct_force`.
 *
 * The general interval costs more than the rest of the solve; cheaper formulas give the same bits
 * where no lane needs it. */
PF_INLINE DirectionInterval direction_interval(Pillar pillar, Diagonals diagonals, ParitySum sum,
                                               Direction estimate, ForceScale scale,
                                               ShearWeights weights) {
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
PF_INLINE DirectionInterval open_interval(DirectionInterval interval, Open open) {
  const Real pi = PF_REAL(3.14159265358979323846);
  DirectionInterval any;
  any.theta_low = PF_REAL(0.0);
  any.theta_high = PF_REAL(1.57079632679489661923);
  any.phi_low = -pi;
  any.phi_high = pi;
  any.magnitude_low = interval.magnitude_low;
  any.magnitude_high = PF_OPEN_N;
  const Mask is_open =
      open.shear_x || open.shear_y || open.normal || open.difference > PF_REAL(0.0);
  return either_interval(is_open, any, interval);
}
