/* The response curve of all sensels: V = r * P(x), where x is the reading r over that of the last
 * knot, within [0, 1], and P a polynomial (docs/derivations/sensor_effects.md, E1). Beyond the last
 * knot V is proportional to r. */

#define PF_CURVE_TERMS 7

/* Coefficients of P, lowest power first, and the scale of x, 1/counts. */
typedef struct {
  float terms[PF_CURVE_TERMS];
  float per_count;
} CurvePolynomial;

PF_INLINE Real curve_position(Real reading, CurvePolynomial curve) {
  const Real x = reading * PF_CONSTANT(Real, curve.per_count);
  const Real above = x > PF_REAL(0.0) ? x : PF_REAL(0.0);
  return above < PF_REAL(1.0) ? above : PF_REAL(1.0);
}

/* P(x). */
PF_INLINE Real curve_factor(Real x, CurvePolynomial curve) {
  Real sum = PF_CONSTANT(Real, curve.terms[PF_CURVE_TERMS - 1]);
  for (int i = PF_CURVE_TERMS - 2; i >= 0; --i) sum = sum * x + PF_CONSTANT(Real, curve.terms[i]);
  return sum;
}

/* V of a reading. */
PF_INLINE Real curve_load(Real reading, CurvePolynomial curve) {
  return reading * curve_factor(curve_position(reading, curve), curve);
}

/* dV/dr up to the last knot, P + x P'; the factor on small noise. */
PF_INLINE Real curve_slope(Real reading, CurvePolynomial curve) {
  const Real x = curve_position(reading, curve);
  Real sum = PF_REAL(0.0);
  for (int i = PF_CURVE_TERMS - 1; i >= 0; --i) {
    sum = sum * x + PF_CONSTANT(Real, curve.terms[i]) * PF_CONSTANT(Real, i + 1);
  }
  return sum;
}
