/* Off-centre pressure: the moment of the pressure on a pillar, which its sensels read as shear,
 * from the normal forces of the pillars beside it (docs/derivations/sensor_effects.md, E7). */

/* The moment over the pitch, N, and its standard deviation. */
typedef struct {
  Real moment;
  Real deviation;
} Lean;

/* outer / (outer + inner) of two forces; negative ones count as zero, and it is zero without any.
 */
PF_INLINE Real outer_part(Real outer, Real inner) {
  const Real zero = PF_REAL(0.0);
  const Real a = outer > zero ? outer : zero;
  const Real b = inner > zero ? inner : zero;
  return a > zero ? a / (a + b) : zero;
}

PF_INLINE Real size_of(Real x) { return x < PF_REAL(0.0) ? -x : x; }

/* Ratios of the normal forces of five pillars in a line: the difference and the sum, less one, of
 * the outer parts of the pillar's neighbours (d, s) and of theirs (e, t). */
typedef struct {
  Real d;
  Real e;
  Real s;
  Real t;
} LineRatios;

PF_INLINE LineRatios line_ratios(Real far_before, Real before, Real own, Real after,
                                 Real far_after) {
  const Real one = PF_REAL(1.0);
  const Real low = outer_part(before, own);
  const Real high = outer_part(after, own);
  const Real far_low = outer_part(far_before, before);
  const Real far_high = outer_part(far_after, after);
  LineRatios ratios;
  ratios.d = high - low;
  ratios.e = far_high - far_low;
  ratios.s = high + low - one;
  ratios.t = far_high + far_low - one;
  return ratios;
}

/* The lean of a pillar with the normal force `own`, N, whose moment is this part of it. */
PF_INLINE Lean lean_of(Real own, Real part, Real deviation) {
  const Real zero = PF_REAL(0.0);
  const Real largest_part = PF_REAL(0.5);
  const Mask loaded = own > zero;
  const Real bounded =
      part < -largest_part ? -largest_part : (part > largest_part ? largest_part : part);
  Lean lean;
  lean.moment = loaded ? own * bounded : zero;
  lean.deviation = loaded ? own * deviation : zero;
  return lean;
}

/* The lean towards `after` of a pillar with the normal force `own`, N; the pillars in its line are
 * far_before, before, own, after, far_after. An odd polynomial in four ratios, exact to first
 * order in a pressure that varies linearly; its coefficients are least squares over wide and narrow
 * bodies on an elastic half-space, and the deviation is what they leave. */
PF_INLINE Lean lean_between(Real far_before, Real before, Real own, Real after, Real far_after) {
  const LineRatios ratios = line_ratios(far_before, before, own, after, far_after);
  const Real d = ratios.d;
  const Real e = ratios.e;
  const Real s = ratios.s;
  const Real t = ratios.t;
  const Real d2 = d * d;
  const Real e2 = e * e;
  const Real s2 = s * s;
  const Real by_d = PF_REAL(0.16666666666666666667) - s2 * (PF_REAL(1.095) + PF_REAL(2.413) * s) +
                    t * t * (PF_REAL(0.204) + PF_REAL(0.361) * t) -
                    d2 * (PF_REAL(0.111) + PF_REAL(0.847) * s + PF_REAL(0.619) * t) +
                    PF_REAL(0.415) * (e2 * s);
  const Real by_e = PF_REAL(1.266) * (s2 * t) - PF_REAL(0.075) * e2;
  const Real deviation = PF_REAL(0.003) + s2 * (PF_REAL(0.118) + PF_REAL(0.531) * d2) +
                         PF_REAL(0.033) * size_of(e - d) + PF_REAL(0.01) * (t * t);
  return lean_of(own, d * by_d + e * by_e, deviation);
}

/* True if a sensel that is usable by its bit of the status is loaded by less than `margin`, or an
 * unusable one by more than -margin. */
PF_INLINE Mask loads_otherwise(Bits status, int bit, Real load, Real margin) {
  const Mask usable = mask_of(status & PF_BITS(bit));
  return (usable && load < margin) || (!usable && load > -margin);
}

/* The shear of a leaning pillar from its own readings and from the ratio of shear to normal force
 * of the pillars around it (docs/derivations/sensor_effects.md, E7a). */

/* The ratio of a component of the shear to the normal force, and its variance. */
typedef struct {
  Real value;
  Real variance;
} ShearRatio;

typedef struct {
  ShearRatio x;
  ShearRatio y;
} ShearRatios;

/* The ratio of a pillar, and its weights in the sums of the pillars beside it and of those diagonal
 * to it; zero where it informs none. */
typedef struct {
  ShearRatio own;
  Real beside;
  Real diagonal;
} WeightedRatio;

typedef struct {
  WeightedRatio x;
  WeightedRatio y;
} WeightedRatios;

/* A sum over the pillars around of their weights, and of these times their difference in ratio and
 * its square. */
typedef struct {
  Real weight;
  Real difference;
  Real square;
} RatioSum;

/* The ratio of a pillar that leans by `lean` times `pitch_over_arm`; `noise` is the deviation of
 * its shear, N. `informs`: its shear is determined by readings that agree. The ratios of pillars
 * beside it differ by a deviation of 0.3, those of diagonal ones by that times the root of 2. Zero
 * without load. */
PF_INLINE WeightedRatio shear_ratio(Real shear, Real normal, Lean lean, Real pitch_over_arm,
                                    Real noise, Mask informs) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real most = PF_REAL(1e12); /* variance; a ratio to next to no force tells nothing */
  const Mask loaded = normal > PF_REAL(1e-37); /* the least with a finite reciprocal */
  const Real per_force = one / (loaded ? normal : one);
  const Real leaning = pitch_over_arm * lean.deviation * per_force;
  const Real noisy = noise * per_force;
  const Real variance = leaning * leaning + noisy * noisy;
  const Real bounded = variance < most ? variance : most;
  const Real beside = bounded + PF_REAL(0.09);
  const Real diagonal = bounded + PF_REAL(0.18);
  const Real per_both = (loaded && informs) ? one / (beside * diagonal) : zero;
  WeightedRatio ratio;
  ratio.own.value = loaded ? (shear - pitch_over_arm * lean.moment) * per_force : zero;
  ratio.own.variance = bounded;
  ratio.beside = diagonal * per_both;
  ratio.diagonal = beside * per_both;
  return ratio;
}

/* The part in the sum around a pillar with the ratio `own` of one with the ratio `other` and this
 * weight. */
PF_INLINE RatioSum ratio_part(Real own, Real other, Real weight) {
  const Real zero = PF_REAL(0.0);
  const Mask informs = weight > zero;
  const Real difference = informs ? other - own : zero;
  RatioSum part;
  part.weight = informs ? weight : zero;
  part.difference = part.weight * difference;
  part.square = part.difference * difference;
  return part;
}

PF_INLINE RatioSum add_ratios(RatioSum a, RatioSum b) {
  a.weight = a.weight + b.weight;
  a.difference = a.difference + b.difference;
  a.square = a.square + b.square;
  return a;
}

/* The precision-weighted mean of a pillar's own ratio and of those around it. Its variance grows
 * with what they disagree by: chi squared about the mean (E7b). */
PF_INLINE ShearRatio mean_ratio(ShearRatio own, RatioSum around) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real most = PF_REAL(1e12); /* as in shear_ratio */
  const Real narrower = own.variance / (one + own.variance * around.weight);
  const Real shift = narrower * around.difference;
  const Real square = around.square - shift * around.difference;
  const Real disagreement = PF_REAL(0.5) * (square < zero ? zero : square);
  const Real wider = narrower * (one + disagreement);
  ShearRatio mean;
  mean.value = own.value + shift;
  mean.variance = wider < most ? wider : most;
  return mean;
}
