/* Corrects a solved pillar by those around it: what correct_forces.cl and, as C++, the host do for
 * its stages. */
#ifdef PF_LEAN
/* Flags a pillar of three or four usable sensels as ambiguous if its force alone, to within two
 * deviations of the correction, `margin_x` and `margin_y`, does not load exactly these (E7). */
PF_INLINE Bits flag_other_region(Solution solution, Real margin_x, Real margin_y, Stages stages) {
  const Real along = PF_REAL(0.70710678118654752440);
  Real shear_x = along * solution.force.shear_x;
  Real shear_y = along * solution.force.shear_y;
#ifdef PF_SHEAR_COEFFICIENT
  if (PF_NAMED(shear_coefficient)) {
    const Real coefficient_x = PF_REAL(1.0) / PF_VALUE(Real, per_coefficient_x);
    const Real coefficient_y = PF_REAL(1.0) / PF_VALUE(Real, per_coefficient_y);
    shear_x = coefficient_x * shear_x;
    shear_y = coefficient_y * shear_y;
    margin_x = coefficient_x * margin_x;
    margin_y = coefficient_y * margin_y;
  }
#endif
  const Real margin = (margin_x + margin_y) * (along + along);
  const Real rising = shear_x + shear_y;
  const Real falling = shear_y - shear_x;
  const Real normal = solution.force.normal;
  const Mask other =
      loads_otherwise(solution.status, PF_STATUS_SENSEL_1, normal + rising, margin) ||
      loads_otherwise(solution.status, PF_STATUS_SENSEL_2, normal + falling, margin) ||
      loads_otherwise(solution.status, PF_STATUS_SENSEL_3, normal - rising, margin) ||
      loads_otherwise(solution.status, PF_STATUS_SENSEL_4, normal - falling, margin);
  /* A fourth sensel that is missing or saturated may bear any load. */
  const Bits unknown = PF_BITS(PF_STATUS_SATURATED | PF_STATUS_INCONSISTENT);
  const Mask known = usable_are(solution.status, 15) ||
                     (at_least_three(solution.status) && !mask_of(solution.status & unknown));
  return solution.status | (bits_of(known && other) & PF_BITS(PF_STATUS_AMBIGUOUS));
}
#endif

#ifdef PF_LEAN
/* The ratios of a pillar that leans by `x` and `y`. Four sensels whose noise is a quarter of the
 * threshold have this noise in each component. */
PF_INLINE WeightedRatios shear_ratios(Force force, Bits status, Lean x, Lean y, Stages stages) {
  const Real pitch_over_arm = PF_VALUE(Real, pitch_over_arm);
  const Real noise = PF_REAL(0.5) * PF_VALUE(Real, threshold) * PF_VALUE(Real, shear_scale);
  const Mask informs = at_least_three(status) && !mask_of(status & PF_BITS(PF_STATUS_INCONSISTENT));
  WeightedRatios ratios;
  ratios.x = shear_ratio(force.shear_x, force.normal, x, pitch_over_arm, noise, informs);
  ratios.y = shear_ratio(force.shear_y, force.normal, y, pitch_over_arm, noise, informs);
  return ratios;
}
#endif

#if defined(PF_PILLAR_LEAK) || defined(PF_LEAN)
/* Corrects a solved pillar by what is known from the pillars around it, its ratios of shear to
 * normal force. Derives direction and intervals from the corrected force. Pillars without load
 * stay.
 */
PF_INLINE Solution correct_solution(Solution solution, ShearRatios ratios, Stages stages) {
  const Mask loaded = mask_of(solution.status & PF_BITS(PF_STATUS_PRESSED));
#ifdef PF_UNCERTAINTY
  Real moved = PF_REAL(0.0);
#endif
#ifdef PF_LEAN
  if (PF_NAMED(lean)) {
    const Real normal = solution.force.normal;
    const Mask has_ratio = loaded && normal > PF_REAL(0.0);
    const Force before = solution.force;
    const Real deviation_x = has_ratio ? normal * sqrt(ratios.x.variance) : PF_REAL(0.0);
    const Real deviation_y = has_ratio ? normal * sqrt(ratios.y.variance) : PF_REAL(0.0);
    solution.force.shear_x = has_ratio ? normal * ratios.x.value : before.shear_x;
    solution.force.shear_y = has_ratio ? normal * ratios.y.value : before.shear_y;
    solution.status = flag_other_region(solution, deviation_x, deviation_y, stages);
#ifdef PF_UNCERTAINTY
    if (PF_NAMED(uncertainty)) {
      moved = plain_length_2(solution.force.shear_x - before.shear_x,
                             solution.force.shear_y - before.shear_y);
      solution.deviations.shear_x = plain_length_2(solution.deviations.shear_x, deviation_x);
      solution.deviations.shear_y = plain_length_2(solution.deviations.shear_y, deviation_y);
    }
#endif
  }
#endif
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  if (PF_NAMED(angles) || PF_NAMED(uncertainty)) {
    solution.direction = direction_of(solution.force);
  }
#endif
#ifdef PF_UNCERTAINTY
  if (PF_NAMED(uncertainty)) {
    const DirectionInterval interval =
        corrected_interval(solution.interval, solution.force, solution.direction, solution.status,
                           PF_VALUE(Real, segment_point), moved, shear_weights(stages));
    solution.interval = either_interval(loaded, interval, solution.interval);
    solution = bounded_solution(solution);
  }
#endif
  return solution;
}
#endif
