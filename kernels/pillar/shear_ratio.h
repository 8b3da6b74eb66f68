/* The shear of a leaning pillar from its own readings and from the ratio of shear to normal force
 * of the pillars around it (docs/derivations/sensor_effects.md, E7a). */

/* The ratio of a component of the shear to the normal force, and its variance; negative where the
 * pillar informs no other. */
typedef struct {
  Real value;
  Real variance;
} ShearRatio;

typedef struct {
  ShearRatio x;
  ShearRatio y;
} ShearRatios;

/* A sum over the pillars around of their weights, and of these times their difference in ratio and
 * its square. */
typedef struct {
  Real weight;
  Real difference;
  Real square;
} RatioSum;

/* The ratio of a pillar that leans by `lean` times `pitch_over_arm`; `noise` is the deviation of
 * its shear, N. `informs`: its shear is determined by readings that agree. Zero without load. */
PF_INLINE ShearRatio shear_ratio(Real shear, Real normal, Lean lean, Real pitch_over_arm,
                                 Real noise, Mask informs) {
  const Real zero = PF_REAL(0.0);
  const Real most = PF_REAL(1e12); /* variance; a ratio to next to no force tells nothing */
  const Mask loaded = normal > zero;
  const Real force = loaded ? normal : PF_REAL(1.0);
  const Real leaning = pitch_over_arm * lean.deviation / force;
  const Real noisy = noise / force;
  const Real variance = leaning * leaning + noisy * noisy;
  const Real bounded = variance < most ? variance : most;
  ShearRatio ratio;
  ratio.value = loaded ? (shear - pitch_over_arm * lean.moment) / force : zero;
  ratio.variance = (loaded && informs) ? bounded : -bounded;
  return ratio;
}

/* The part in the sum of a pillar with the normal force `normal`, whose distance in pillars has the
 * square `distance`. The ratios of neighbours differ by a deviation of 0.3. */
PF_INLINE RatioSum ratio_part(ShearRatio own, ShearRatio other, Real normal, Real distance) {
  const Real zero = PF_REAL(0.0);
  const Real spread = PF_REAL(0.09) * distance;
  const Mask informs = normal > zero && other.variance >= zero;
  RatioSum part;
  part.weight = informs ? PF_REAL(1.0) / (other.variance + spread) : zero;
  const Real difference = informs ? other.value - own.value : zero;
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
  const Real variance = size_of(own.variance);
  const Real whole = one + variance * around.weight;
  const Real shift = variance * around.difference / whole;
  const Real square = around.square - shift * around.difference;
  const Real disagreement = PF_REAL(2.0) * (square < zero ? zero : square);
  const Real wider = (variance / whole) * (one + disagreement);
  ShearRatio mean;
  mean.value = own.value + shift;
  mean.variance = wider < most ? wider : most;
  return mean;
}
