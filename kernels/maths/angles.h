/* Magnitude and direction of a force; (theta, phi) is the direction from which it comes
 * (docs/derivations/pillar_model.md, equation M2). */
typedef struct {
  Real magnitude; /* N */
  Real theta;     /* rad from the outward normal, [0, pi] */
  Real phi;       /* rad in the plane of the skin, [-pi, pi]; 0 where there is no shear */
} Direction;

/* Within 2 ULP (magnitude) and 4 ULP (angles) of the exact values of the given components. */
static inline Direction direction_of(Force force) {
  const Real shear = hypot(force.shear_x, force.shear_y);
  Direction direction;
  direction.magnitude = hypot(shear, force.normal);
  direction.theta = atan2(shear, force.normal);
  direction.phi = shear > PF_REAL(0.0) ? atan2(-force.shear_y, -force.shear_x) : PF_REAL(0.0);
  return direction;
}
