/* The response curve of all sensels: V = r * P(t) with a polynomial P of t = x or the root of x,
 * where x is the reading r over the reach of the fit, within [0, 1]
 * (docs/derivations/sensor_effects.md, E1). Beyond the reach V is proportional to r. */

PF_INLINE Real curve_position(Real reading, CurvePolynomial curve) {
  const Real x = reading * PF_CONSTANT(Real, curve.per_count);
  const Real above = x > PF_REAL(0.0) ? x : PF_REAL(0.0);
  const Real within = above < PF_REAL(1.0) ? above : PF_REAL(1.0);
  if (curve.root) return sqrt(within);
  return within;
}

/* P(t). */
PF_INLINE Real curve_factor(Real t, CurvePolynomial curve) {
  Real sum = PF_CONSTANT(Real, curve.terms[PF_CURVE_TERMS - 1]);
  PF_UNROLL
  for (int i = PF_CURVE_TERMS - 2; i >= 0; --i) sum = sum * t + PF_CONSTANT(Real, curve.terms[i]);
  return sum;
}

/* V of a reading. */
PF_INLINE Real curve_load(Real reading, CurvePolynomial curve) {
  return reading * curve_factor(curve_position(reading, curve), curve);
}

/* dV/dr within the reach, P + t P' or, of the root, P + t P' / 2; the factor on small noise. */
PF_INLINE Real curve_slope(Real reading, CurvePolynomial curve) {
  const Real t = curve_position(reading, curve);
  const float step = curve.root ? 0.5f : 1.0f;
  float weight = 1.0f + step * PF_CURVE_LAST_POWER;
  Real sum = PF_REAL(0.0);
  PF_UNROLL
  for (int i = PF_CURVE_TERMS - 1; i >= 0; --i) {
    sum = sum * t + PF_CONSTANT(Real, curve.terms[i] * weight);
    weight = weight - step;
  }
  return sum;
}
