/* Lengths and angles. In single precision from + - * / and sqrt alone, so that every device that
 * rounds them correctly gives the same bits, and a vector of lanes costs no call; in double they
 * are those of the C++ library. Largest errors, measured against 113 bits:
 * docs/derivations/elementary.md. */

static inline Real larger_of(Real a, Real b) { return a < b ? b : a; }

/* A power of two that brings squares of numbers up to `largest` into range, and its inverse. */
typedef struct {
  Real down;
  Real up;
} Scaling;

static inline Scaling scaling_for(Real largest) {
  const Mask is_large = largest > PF_REAL(0x1p60);
  const Mask is_small = largest < PF_REAL(0x1p-40);
  const Real one = PF_REAL(1.0);
  Scaling scaling;
  scaling.down = is_large ? PF_REAL(0x1p-70) : (is_small ? PF_REAL(0x1p100) : one);
  scaling.up = is_large ? PF_REAL(0x1p70) : (is_small ? PF_REAL(0x1p-100) : one);
  return scaling;
}

/* sqrt(x^2 + y^2) and sqrt(x^2 + y^2 + z^2) of numbers that are scaled already. */
static inline Real plain_length_2(Real x, Real y) { return sqrt(x * x + y * y); }
static inline Real plain_length_3(Real x, Real y, Real z) { return sqrt(x * x + y * y + z * z); }

#if !defined(__cplusplus) || PF_PRECISION == 32

/* sqrt(x^2 + y^2), without overflow and underflow on the way; 1.25 ULP. */
static inline Real length_2(Real x, Real y) {
  const Scaling scaling = scaling_for(larger_of(fabs(x), fabs(y)));
  return plain_length_2(x * scaling.down, y * scaling.down) * scaling.up;
}

/* sqrt(x^2 + y^2 + z^2), as before; 1.5 ULP. */
static inline Real length_3(Real x, Real y, Real z) {
  const Scaling scaling = scaling_for(larger_of(larger_of(fabs(x), fabs(y)), fabs(z)));
  return plain_length_3(x * scaling.down, y * scaling.down, z * scaling.down) * scaling.up;
}

/* The angle of the point (x, y) from the x axis, (-pi, pi]; zero at the origin; 3 ULP. */
static inline Real angle_of(Real y, Real x) {
  const Real zero = PF_REAL(0.0);
  const Real pi = PF_REAL(3.14159265358979323846);
  const Real quarter_turn = PF_REAL(1.57079632679489661923);
  const Real eighth_turn = PF_REAL(0.78539816339744830962);
  const Real tan_pi_8 = PF_REAL(0.41421356237309504880);
  const Real width = fabs(x);
  const Real height = fabs(y);
  const Mask is_steep = height > width;
  const Real least = is_steep ? width : height;
  const Real most = is_steep ? height : width;

  /* The angle from the axis or the bisector that is nearest, within pi / 8. */
  const Mask by_bisector = least > tan_pi_8 * most;
  const Real numerator = by_bisector ? least - most : least;
  const Real denominator = by_bisector ? least + most : most;
  const Real tangent = numerator / (most > zero ? denominator : PF_REAL(1.0));
  const Real square = tangent * tangent;
  const Real series =
      PF_REAL(-0.3333294987678528) +
      square * (PF_REAL(0.19977709650993347) +
                square * (PF_REAL(-0.13877679407596588) + square * PF_REAL(0.08053722977638245)));
  const Real part = tangent + tangent * (square * series);

  /* That axis or bisector, and on which side of it the point is. */
  const Real in_quadrant = by_bisector ? eighth_turn : (is_steep ? quarter_turn : zero);
  const Mask is_left = x < zero;
  const Real nearest = is_left ? pi - in_quadrant : in_quadrant;
  const Real angle = (is_steep != is_left) ? nearest - part : nearest + part;
  return y < zero ? -angle : angle;
}

#else

static inline Real length_2(Real x, Real y) { return hypot(x, y); }
static inline Real length_3(Real x, Real y, Real z) { return hypot(hypot(x, y), z); }
static inline Real angle_of(Real y, Real x) { return atan2(y, x); }

#endif
