/* Magnitude and direction of a force; (theta, phi) is the direction from which it comes
 * (docs/derivations/pillar_model.md, equation M2). */
typedef struct {
  Real magnitude; /* N */
  Real theta;     /* rad from the outward normal, [0, pi] */
  Real phi;       /* rad in the plane of the skin, [-pi, pi], and 0 where there is no shear */
} Direction;

/* Magnitude and direction of a force, within 3 ULP of the exact values. */
PF_INLINE Direction direction_of(Force force) {
  const Real zero = PF_REAL(0.0);
  const Lengths lengths = lengths_of(force.shear_x, force.shear_y, force.normal);
  Direction direction;
  direction.magnitude = lengths.all;
  direction.theta = upper_angle_of(lengths.first_two, force.normal);
  /* Subtracted, not negated: a component +0 must not become -0, on the far side of the cut. */
  direction.phi = angle_of(zero - force.shear_y, zero - force.shear_x);
  return direction;
}
