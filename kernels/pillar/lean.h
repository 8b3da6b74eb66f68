/* Off-centre pressure: the moment of the pressure on a pillar, which its sensels read as shear,
 * from the normal forces of the pillars beside it (docs/derivations/sensor_effects.md, E7). */

/* The moment over the pitch, N, and its standard deviation. */
typedef struct {
  Real moment;
  Real deviation;
} Lean;

/* The lean of a pillar with the normal force `own` towards `after`, N. Negative forces count as
 * zero. The polynomial is exact, to first
 * order, in a pressure that varies linearly; its other coefficients are
 * least squares over bodies of six shapes on an elastic half-space, and the deviation is what they
 * leave. */
PF_INLINE Lean lean_between(Real before, Real own, Real after) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real low = before > zero ? before : zero;
  const Real high = after > zero ? after : zero;
  const Mask loaded = own > zero;
  const Real force = loaded ? own : one;
  const Real a = low / (low + force);
  const Real b = high / (high + force);
  const Real difference = b - a;
  const Real sum = a + b;
  const Real product = PF_REAL(4.0) * a * b;
  const Real uneven = PF_REAL(0.336) * (one - product) - PF_REAL(1.149) * (sum - product) +
                      PF_REAL(1.485) * (sum * sum - product);
  const Real moment = force * (difference * (product * PF_REAL(0.16666666666666666667) + uneven));
  const Real steep = difference < zero ? -difference : difference;
  const Real cube = steep * steep * steep;
  const Real apart = one - (sum + sum);
  const Real lonely = apart > zero ? PF_REAL(0.25) * (apart * apart) : zero;
  const Real deviation =
      PF_REAL(0.01) + PF_REAL(0.04) * steep + PF_REAL(0.11) * (cube * cube) + lonely;
  Lean lean;
  lean.moment = loaded ? moment : zero;
  lean.deviation = loaded ? force * deviation : zero;
  return lean;
}
