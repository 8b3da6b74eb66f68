/* The paper's estimator: its equations (2), (5), (7) and (9), the midpoint of the contour in region
 * 3 and the four directions of region 4, with errata corrected (docs/derivations/paper_solve.md).
 * The baseline for `direct_force`.
 *
 * Readings enter as ratios to the largest of the four, as in the paper's (4). Regions 2 to 4 have
 * one equation for each of four orientations. They are quarter turns of each other: a is the usable
 * sensel whose clockwise neighbour is not usable, and b, c, d follow counter-clockwise. A turned
 * pillar has a at 45 degrees. */

/* Readings of a turned pillar as fractions of the largest; zero where unusable. */
typedef struct {
  Real a;
  Real b;
  Real c;
  Real d;
} Ratios;

/* The direction from which a force comes, in radians. */
typedef struct {
  Real theta;
  Real phi;
} Angles;

/* Position of sensel a; sensel 1 if all masks are false. */
typedef struct {
  Mask at_2;
  Mask at_3;
  Mask at_4;
} Turn;

/* Cosines of the angles between the direction in the plane and sensels a and b; those of c and d
 * are their negatives. */
typedef struct {
  Real a;
  Real b;
} SenselCosines;

PF_INLINE SenselCosines sensel_cosines(Real phi) {
  const Real cos_45_deg = PF_REAL(0.70710678118654752440);
  const Real x = cos(phi);
  const Real y = sin(phi);
  SenselCosines cosines;
  cosines.a = cos_45_deg * (x + y);
  cosines.b = cos_45_deg * (y - x);
  return cosines;
}

/* Equation (5) for sensels i and j at these cosines; zero where it is 0/0. */
PF_INLINE Real theta_of_pair(Real v_i, Real cos_i, Real v_j, Real cos_j) {
  return atan2(fabs(v_i - v_j), fabs(v_i * cos_j - v_j * cos_i));
}

/* Four usable: (7), then (5) with the diagonal along which the shear lies more (P1). The shear is
 * zero where (7) is 0/0: under a purely normal force, or where its products underflow. */
PF_INLINE Angles paper_region_1(Ratios v) {
  const Real zero = PF_REAL(0.0);
  const Real up = v.c * v.d - v.a * v.b;
  const Real right = v.b * v.c - v.a * v.d;
  const Mask no_shear = (up == zero) && (right == zero);
  Angles angles;
  angles.phi = atan2(up, right);
  const SenselCosines cosines = sensel_cosines(angles.phi);
  const Mask along_a = fabs(cosines.a) >= fabs(cosines.b);
  const Real cosine = along_a ? cosines.a : cosines.b;
  const Real theta = theta_of_pair(along_a ? v.a : v.b, cosine, along_a ? v.c : v.d, -cosine);
  angles.theta = no_shear ? zero : theta;
  return angles;
}

/* All but d usable: (9), then (5) with b, opposite d, and the neighbour of b that differs more from
 * it (P2). If d is inactive, that is the weaker one; if d is missing, the weaker one may equal b,
 * where (5) is 0/0. */
PF_INLINE Angles paper_region_2(Ratios v) {
  Angles angles;
  angles.phi = atan2(v.c - v.b, v.b - v.a);
  const SenselCosines cosines = sensel_cosines(angles.phi);
  const Mask by_a = fabs(v.b - v.a) > fabs(v.b - v.c);
  angles.theta = theta_of_pair(v.b, cosines.b, by_a ? v.a : v.c, by_a ? cosines.a : -cosines.a);
  return angles;
}

/* Only a and b usable: theta is the midpoint of the contour (P3), and (5) gives phi (P4). */
PF_INLINE Angles paper_region_3(Ratios v) {
  const Real one = PF_REAL(1.0);
  const Real quarter_turn = PF_REAL(1.57079632679489661923);
  const Real sqrt_2 = PF_REAL(1.41421356237309504880);
  const Real weaker = v.a < v.b ? v.a : v.b;
  const Real rest = PF_REAL(2.0) - weaker;
  const Real border = atan2(sqrt(rest * rest + weaker * weaker), weaker);
  const Real balance = (v.a - v.b) / (v.a + v.b);
  Angles angles;
  angles.theta = PF_REAL(0.5) * (border + quarter_turn);
  const Real cotangent = cos(angles.theta) / sin(angles.theta);
  const Real sine = balance * sqrt_2 * cotangent / sqrt(one + balance * balance);
  angles.phi = -quarter_turn - atan(balance) - asin(sine);
  return angles;
}

/* Only a usable: the direction opposite to it, in the plane of the skin. */
PF_INLINE Angles paper_region_4(void) {
  Angles angles;
  angles.theta = PF_REAL(1.57079632679489661923);
  angles.phi = PF_REAL(-2.35619449019234492885);
  return angles;
}

/* A reading as a fraction of the largest: 1 for that one, also where a device rounds quotients
 * otherwise than IEEE 754. */
PF_INLINE Real ratio_to(Real largest, Real reading) {
  return reading == largest ? PF_REAL(1.0) : reading / largest;
}

PF_INLINE Ratios turned_ratios(Real v1, Real v2, Real v3, Real v4, Turn turn) {
  Ratios v;
  v.a = turn.at_2 ? v2 : (turn.at_3 ? v3 : (turn.at_4 ? v4 : v1));
  v.b = turn.at_2 ? v3 : (turn.at_3 ? v4 : (turn.at_4 ? v1 : v2));
  v.c = turn.at_2 ? v4 : (turn.at_3 ? v1 : (turn.at_4 ? v2 : v3));
  v.d = turn.at_2 ? v1 : (turn.at_3 ? v2 : (turn.at_4 ? v3 : v4));
  return v;
}

/* The force on a turned pillar whose largest reading is `largest` counts: its magnitude by (2) at
 * that sensel, its components by M2, turned back. */
PF_INLINE Force turned_force(Ratios v, Angles angles, Real largest, Turn turn, ForceScale scale) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const SenselCosines cosines = sensel_cosines(angles.phi);
  const Real at_largest =
      v.a == one ? cosines.a : (v.b == one ? cosines.b : (v.c == one ? -cosines.a : -cosines.b));
  /* Shear presses the sensel that it points to; underflow may reverse the sign. */
  const Real cosine = at_largest > zero ? zero : at_largest;
  const Real cos_theta = cos(angles.theta);
  const Real sin_theta = sin(angles.theta);
  const Real response = cos_theta - sin_theta * cosine;
  const Real magnitude = largest * (scale.normal + scale.normal) / response;
  const Real x = magnitude * (sin_theta * -cos(angles.phi));
  const Real y = magnitude * (sin_theta * -sin(angles.phi));
  Force force;
  force.shear_x = turn.at_2 ? -y : (turn.at_3 ? -x : (turn.at_4 ? y : x));
  force.shear_y = turn.at_2 ? x : (turn.at_3 ? -y : (turn.at_4 ? -x : y));
  force.normal = magnitude * cos_theta;
  return force;
}

/* The force on a pillar by the paper's equations. The paper does not cover saturated and missing
 * sensels: they count as usable and as unusable. Nor does it cover two opposite sensels alone:
 * `direct_force` solves them. */
PF_INLINE Force paper_force(Pillar pillar, Diagonals diagonals, ParitySum sum, ForceScale scale) {
  const Real zero = PF_REAL(0.0);
  const Mask u1 = is_pressed(pillar.s1);
  const Mask u2 = is_pressed(pillar.s2);
  const Mask u3 = is_pressed(pillar.s3);
  const Mask u4 = is_pressed(pillar.s4);
  const Mask four = u1 && u2 && u3 && u4;
  const Mask adjacent = (u1 || u3) && (u2 || u4);
  const Mask three = adjacent && ((u1 && u3) || (u2 && u4));
  const Mask no_region = (u1 == u3) && (u2 == u4) && !four;
  Turn turn;
  turn.at_2 = u2 && !u1;
  turn.at_3 = u3 && !u2;
  turn.at_4 = u4 && !u3;

  const Real r1 = u1 ? pillar.s1.reading : zero;
  const Real r2 = u2 ? pillar.s2.reading : zero;
  const Real r3 = u3 ? pillar.s3.reading : zero;
  const Real r4 = u4 ? pillar.s4.reading : zero;
  const Real rising = r1 > r3 ? r1 : r3;
  const Real falling = r2 > r4 ? r2 : r4;
  const Real largest = no_region ? PF_REAL(1.0) : (rising > falling ? rising : falling);
  const Ratios v = turned_ratios(ratio_to(largest, r1), ratio_to(largest, r2),
                                 ratio_to(largest, r3), ratio_to(largest, r4), turn);

  const Angles region_1 = paper_region_1(v);
  const Angles region_2 = paper_region_2(v);
  const Angles region_3 = paper_region_3(v);
  const Angles region_4 = paper_region_4();
  Angles angles;
  angles.theta = four ? region_1.theta
                      : (three ? region_2.theta : (adjacent ? region_3.theta : region_4.theta));
  angles.phi =
      four ? region_1.phi : (three ? region_2.phi : (adjacent ? region_3.phi : region_4.phi));

  const Force direct = direct_force(diagonals, sum, scale);
  Force force = turned_force(v, angles, largest, turn, scale);
  force.shear_x = no_region ? direct.shear_x : force.shear_x;
  force.shear_y = no_region ? direct.shear_y : force.shear_y;
  force.normal = no_region ? direct.normal : force.normal;
  return force;
}
