/* Lengths, angles and powers. Single precision uses only + - * / and sqrt: every device that rounds
 * them correctly gives the same bits, and a vector of lanes needs no call. Double precision uses
 * the C++ library. Largest errors, measured against 113 bits: docs/derivations/elementary.md. */

PF_INLINE Real larger_of(Real a, Real b) { return a < b ? b : a; }

/* A deviation or an end of an interval that the readings do not bound, N: finite, so that what is
 * computed from it is a number. */
#define PF_OPEN_N PF_REAL(1e38)

/* At most PF_OPEN_N, which it is for NaN too. */
PF_INLINE Real bounded_n(Real newtons) { return newtons < PF_OPEN_N ? newtons : PF_OPEN_N; }

/* A power of two by which squares of numbers up to `largest` stay in range, and its inverse. */
typedef struct {
  Real down;
  Real up;
} Scaling;

PF_INLINE Scaling scaling_for(Real largest) {
  const Mask is_large = largest > PF_REAL(0x1p60);
  const Mask is_small = largest < PF_REAL(0x1p-40);
  const Real one = PF_REAL(1.0);
  Scaling scaling;
  scaling.down = is_large ? PF_REAL(0x1p-70) : (is_small ? PF_REAL(0x1p100) : one);
  scaling.up = is_large ? PF_REAL(0x1p70) : (is_small ? PF_REAL(0x1p-100) : one);
  return scaling;
}

/* True where squares of numbers up to `largest` fall below the range. Zeros need no scaling. */
PF_INLINE Mask is_small(Real largest) {
  return (largest < PF_REAL(0x1p-40)) && (largest > PF_REAL(0.0));
}

/* True if squares of numbers up to `largest` leave the range in any lane. */
PF_INLINE bool needs_scaling(Real largest) {
  return any_lane(is_small(largest) || (largest > PF_REAL(0x1p60)));
}

/* Lengths of a vector of three components, and of its first two. */
typedef struct {
  Real first_two;
  Real all;
} Lengths;

/* sqrt(x^2 + y^2) and sqrt(x^2 + y^2 + z^2) without scaling. */
PF_INLINE Real plain_length_2(Real x, Real y) { return sqrt(x * x + y * y); }
PF_INLINE Real plain_length_3(Real x, Real y, Real z) { return sqrt(x * x + y * y + z * z); }

#if !defined(__cplusplus) || PF_PRECISION == 32

/* sqrt(x^2 + y^2) without intermediate overflow and underflow; 1.25 ULP. */
PF_INLINE Real length_2(Real x, Real y) {
  const Real largest = larger_of(fabs(x), fabs(y));
  if (!needs_scaling(largest)) return plain_length_2(x, y);
  const Scaling scaling = scaling_for(largest);
  return plain_length_2(x * scaling.down, y * scaling.down) * scaling.up;
}

/* sqrt(x^2 + y^2 + z^2) without intermediate overflow and underflow; 1.5 ULP. */
PF_INLINE Real length_3(Real x, Real y, Real z) {
  const Real largest = larger_of(larger_of(fabs(x), fabs(y)), fabs(z));
  if (!needs_scaling(largest)) return plain_length_3(x, y, z);
  const Scaling scaling = scaling_for(largest);
  return plain_length_3(x * scaling.down, y * scaling.down, z * scaling.down) * scaling.up;
}

/* length_2 and length_3 of a vector, with one test for both. */
PF_INLINE Lengths lengths_of(Real x, Real y, Real z) {
  const Real larger = larger_of(fabs(x), fabs(y));
  const Real largest = larger_of(larger, fabs(z));
  const Real square = x * x + y * y;
  Lengths lengths = {sqrt(square), sqrt(square + z * z)};
  if (any_lane(is_small(larger) || is_small(largest) || largest > PF_REAL(0x1p60))) {
    lengths.first_two = length_2(x, y);
    lengths.all = length_3(x, y, z);
  }
  return lengths;
}

/* Polar angle of a point in the first quadrant: the nearest of the axes and their bisector, and the
 * angle from there, at most pi / 8. */
typedef struct {
  Real nearest; /* rad from the x axis */
  Real part;    /* rad, towards the y axis, or away from it where `is_steep` */
  Mask is_steep;
} QuadrantAngle;

PF_INLINE QuadrantAngle quadrant_angle(Real y, Real x) {
  const Real zero = PF_REAL(0.0);
  const Real quarter_turn = PF_REAL(1.57079632679489661923);
  const Real eighth_turn = PF_REAL(0.78539816339744830962);
  const Real tan_pi_8 = PF_REAL(0.41421356237309504880);
  QuadrantAngle angle;
  angle.is_steep = y > x;
  const Real least = angle.is_steep ? x : y;
  const Real most = angle.is_steep ? y : x;
  const Mask by_bisector = least > tan_pi_8 * most;
  const Real numerator = by_bisector ? least - most : least;
  const Real denominator = by_bisector ? least + most : most;
  const Real tangent = numerator / (most > zero ? denominator : PF_REAL(1.0));
  const Real square = tangent * tangent;
  const Real series =
      PF_REAL(-0.3333294987678528) +
      square * (PF_REAL(0.19977709650993347) +
                square * (PF_REAL(-0.13877679407596588) + square * PF_REAL(0.08053722977638245)));
  angle.part = tangent + tangent * (square * series);
  angle.nearest = by_bisector ? eighth_turn : (angle.is_steep ? quarter_turn : zero);
  return angle;
}

/* Polar angle of (x, y) with x, y >= 0: [0, pi / 2]; 3 ULP. */
PF_INLINE Real acute_angle_of(Real y, Real x) {
  const QuadrantAngle angle = quadrant_angle(y, x);
  return angle.is_steep ? angle.nearest - angle.part : angle.nearest + angle.part;
}

/* Polar angle of (x, y) with y >= 0: [0, pi]; 3 ULP. */
PF_INLINE Real upper_angle_of(Real y, Real x) {
  const QuadrantAngle angle = quadrant_angle(y, fabs(x));
  const Mask is_left = x < PF_REAL(0.0);
  const Real nearest = is_left ? PF_REAL(3.14159265358979323846) - angle.nearest : angle.nearest;
  return (angle.is_steep != is_left) ? nearest - angle.part : nearest + angle.part;
}

/* Polar angle of (x, y): [-pi, pi], with the sign of y as atan2; zero at the origin; 3 ULP. */
PF_INLINE Real angle_of(Real y, Real x) { return copysign(upper_angle_of(fabs(y), x), y); }

/* base^exponent for a normal base above zero and |exponent| up to 10; 3 + |exponent| ULP. Below
 * 2^-126 and from 2^128 on it stays near these. */
PF_INLINE Real power_of(Real base, Real exponent) {
  const Real one = PF_REAL(1.0);
  const Word word = word_of(base) + PF_WORD(0x004afb0d); /* 1 - sqrt(1/2), in last places */
  const Real whole = real_of_word((word >> PF_WORD(23)) | PF_WORD(0x4b000000)) -
                     PF_REAL(8388735.0); /* 2^23 + 127 */
  const Real above =
      real_of_word((word & PF_WORD(0x007fffff)) + PF_WORD(0x3f3504f3)) - one; /* sqrt(1/2) */
  const Real logarithm =
      above *
      (PF_REAL(1.4426947832107544) +
       above *
           (PF_REAL(-0.7213566303253174) +
            above *
                (PF_REAL(0.48093846440315247) +
                 above * (PF_REAL(-0.3601038157939911) +
                          above * (PF_REAL(0.28672733902931213) +
                                   above * (PF_REAL(-0.2499236911535263) +
                                            above * (PF_REAL(0.23674611747264862) +
                                                     above * PF_REAL(-0.14599063992500305))))))));
  const Real coarse = real_of_word(word_of(exponent) & PF_WORD(0xffff0000));
  const Real fine = (exponent - coarse) * whole + exponent * logarithm;
  const Real product = coarse * whole; /* exact */
  const Real least = PF_REAL(-126.0);
  const Real most = PF_REAL(128.0);
  const Real rounded = floor(product + fine + PF_REAL(0.5));
  const Real steps = rounded < least ? least : (rounded < most ? rounded : most);
  const Real part = (product - rounded) + fine;
  const Real scale = real_of_word((word_of(steps + PF_REAL(12582912.0)) << PF_WORD(23)) +
                                  PF_WORD(0x3f800000)); /* 1.5 x 2^23: the last bits are whole */
  return scale * (one + part * (PF_REAL(0.6931470036506653) +
                                part * (PF_REAL(0.24022242426872253) +
                                        part * (PF_REAL(0.05550733581185341) +
                                                part * (PF_REAL(0.009671512991189957) +
                                                        part * PF_REAL(0.001326472731307149))))));
}

#else

PF_INLINE Real length_2(Real x, Real y) { return hypot(x, y); }
PF_INLINE Real length_3(Real x, Real y, Real z) { return hypot(hypot(x, y), z); }
PF_INLINE Lengths lengths_of(Real x, Real y, Real z) {
  const Lengths lengths = {length_2(x, y), length_3(x, y, z)};
  return lengths;
}
PF_INLINE Real acute_angle_of(Real y, Real x) { return atan2(y, x); }
PF_INLINE Real upper_angle_of(Real y, Real x) { return atan2(y, x); }
PF_INLINE Real angle_of(Real y, Real x) { return atan2(y, x); }
PF_INLINE Real power_of(Real base, Real exponent) { return pow(base, exponent); }

#endif
