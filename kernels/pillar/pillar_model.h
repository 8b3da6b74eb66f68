/* The forward model of one pillar: equation (2) of the paper in its linear form
 * (docs/derivations/pillar_model.md, equation M3). */

/* A force on a pillar, newtons. The shear acts on the skin, +x right and +y up; the normal force is
 * positive when the skin is pressed. */
typedef struct {
  Real shear_x;
  Real shear_y;
  Real normal;
} Force;

/* Readings of the sensels at 45, 135, 225 and 315 degrees, counts. */
typedef struct {
  Real v1;
  Real v2;
  Real v3;
  Real v4;
} Readings;

/* Readings of the four sensels, counts, if they responded to tension too: negative where the pillar
 * lifts off. `counts_per_newton` is k. Each is within 5 ULP of the largest of the four. */
PF_INLINE Readings model_readings(Force force, Real counts_per_newton) {
  const Real cos_45_deg = PF_REAL(0.70710678118654752440);
  const Real pressed = counts_per_newton * force.normal;
  const Real rising = counts_per_newton * (cos_45_deg * (force.shear_y + force.shear_x));
  const Real falling = counts_per_newton * (cos_45_deg * (force.shear_y - force.shear_x));
  Readings readings;
  readings.v1 = pressed + rising;
  readings.v2 = pressed + falling;
  readings.v3 = pressed - rising;
  readings.v4 = pressed - falling;
  return readings;
}
