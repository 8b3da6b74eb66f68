/* Intervals of magnitude and direction after a correction of the force by its neighbours
 * (docs/derivations/sensor_effects.md, E10). */

/* True where exactly the sensels of `bits` are usable. */
PF_INLINE Mask usable_are(Bits status, int bits) {
  return !mask_of((status & PF_BITS(15)) ^ PF_BITS(bits));
}

PF_INLINE Mask at_least_three(Bits status) {
  return usable_are(status, 15) || usable_are(status, 7) || usable_are(status, 11) ||
         usable_are(status, 13) || usable_are(status, 14);
}

/* The interval of a segment of forces whose component `free` falls by `slope` per newton of normal
 * force; `known` is the other one, `high` the largest normal force. `along_y`: the free one is
 * shear_y. */
PF_INLINE DirectionInterval segment_interval(Real known, Real free, Real normal, Real high,
                                             Real slope, Mask along_y) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real start = free + slope * normal; /* of the free component, at no normal force */
  const Real end = start - slope * high;
  const Real length = high * (slope * slope + one);
  const Real pull = slope * start;
  const Real part = (pull > zero && length > zero) ? pull / length : zero;
  const Real nearest = (part < one ? part : one) * high;
  /* The steepest direction: where the tangent of theta is least. */
  const Real square = start * start + known * known;
  const Real turn = pull > zero ? square / pull : high;
  const Real steep = turn < high ? turn : high;
  const Real x_start = along_y ? known : start;
  const Real y_start = along_y ? start : known;
  const Real x_end = along_y ? known : end;
  const Real y_end = along_y ? end : known;
  const Real from = angle_of(zero - y_start, zero - x_start);
  const Real to = angle_of(zero - y_end, zero - x_end);
  const Mask clockwise = x_start * y_end < x_end * y_start;
  const Real longest_start = plain_length_2(known, start);
  const Real longest_end = length_3(known, end, high);
  DirectionInterval interval;
  interval.theta_low = upper_angle_of(plain_length_2(known, start - slope * steep), steep);
  interval.theta_high = PF_REAL(1.57079632679489661923);
  interval.phi_low = clockwise ? to : from;
  interval.phi_high = clockwise ? from : to;
  interval.magnitude_low = length_3(known, start - slope * nearest, nearest);
  interval.magnitude_high = longest_start > longest_end ? longest_start : longest_end;
  return interval;
}

/* The interval of a corrected force: a point with three or four usable sensels, a segment with two
 * adjacent ones; else any direction, and the magnitude before, widened by `moved` newtons. */
PF_INLINE DirectionInterval corrected_interval(DirectionInterval before, Force force,
                                               Direction direction, Bits status, Real segment_point,
                                               Real moved, ShearWeights weights) {
  const Real zero = PF_REAL(0.0);
  const Real pi = PF_REAL(3.14159265358979323846);
  const Mask upper = usable_are(status, 3);
  const Mask left = usable_are(status, 6);
  const Mask lower = usable_are(status, 12);
  const Mask right = usable_are(status, 9);
  const Mask along_y = upper || lower;
  const Real root = PF_REAL(1.41421356237309504880);
  const Real slope = root * (along_y ? weights.y : weights.x);
  const DirectionInterval segment = segment_interval(
      along_y ? force.shear_x : force.shear_y, along_y ? force.shear_y : force.shear_x,
      force.normal, force.normal / segment_point, (lower || left) ? -slope : slope, along_y);
  const Real shorter = before.magnitude_low - moved;
  DirectionInterval any;
  any.theta_low = zero;
  any.theta_high = PF_REAL(1.57079632679489661923);
  any.phi_low = -pi;
  any.phi_high = pi;
  any.magnitude_low = shorter > zero ? shorter : zero;
  any.magnitude_high = before.magnitude_high + moved;
  const Mask on_segment =
      (along_y || left || right) && !mask_of(status & PF_BITS(PF_STATUS_SATURATED));
  const DirectionInterval open = either_interval(on_segment, segment, any);
  return either_interval(at_least_three(status), point_interval(direction), open);
}
