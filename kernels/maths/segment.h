/* The forces between which the readings of an ambiguous pillar leave the choice, as a segment along
 * which the normal force is free (docs/derivations/field.md, F1 to F5). For two adjacent usable
 * sensels. */

/* One component of the shear is what it is; the other shrinks as the normal force grows, from
 * `moving` where it is zero, by sqrt(2) of it. */
typedef struct {
  Real fixed;  /* size of the one component, N */
  Real moving; /* size of the other where nothing presses, N */
  Real high;   /* largest normal force, N; the least is zero */
} Segment;

/* Whether the shear's y component is the one that moves: the usable sensels are the upper or the
 * lower two. */
static inline Mask moves_vertically(Bits status) {
  const Bits usable = status & PF_BITS(15);
  return mask_of((usable == PF_BITS(3)) | (usable == PF_BITS(12)));
}

/* The segment of which the direct solve reports `point`, at `fraction` of its normal forces (F1).
 */
static inline Segment segment_of(Force point, Mask vertical, Real fraction) {
  Segment segment;
  segment.fixed = fabs(vertical ? point.shear_x : point.shear_y);
  segment.moving = fabs(vertical ? point.shear_y : point.shear_x) +
                   PF_REAL(1.41421356237309504880) * point.normal;
  segment.high = point.normal / fraction;
  return segment;
}

/* The force whose normal force is `normal`, of the segment on which `point` lies (F2). */
static inline Force force_on_segment(Force point, Mask vertical, Real normal) {
  const Real grown = PF_REAL(1.41421356237309504880) * (normal - point.normal);
  const Real moved = vertical ? point.shear_y : point.shear_x;
  const Real moving = moved - copysign(PF_REAL(1.0), moved) * grown;
  Force force;
  force.shear_x = vertical ? point.shear_x : moving;
  force.shear_y = vertical ? moving : point.shear_y;
  force.normal = normal;
  return force;
}

/* Shear over normal force where the normal force is `normal`, which is above zero. */
static inline Real ratio_on_segment(Segment segment, Real normal) {
  const Real moving = segment.moving - PF_REAL(1.41421356237309504880) * normal;
  return length_2(segment.fixed, moving) / normal;
}

/* The normal force at which shear is `ratio` times it (F3); beyond the segment where no force of it
 * has that ratio. Zero where the segment is a point. */
static inline Real normal_at_ratio(Segment segment, Real ratio) {
  const Real zero = PF_REAL(0.0);
  const Real largest = larger_of(segment.fixed, segment.moving);
  const Mask is_point = !(largest > zero);
  const Real unit = is_point ? PF_REAL(1.0) : largest;
  const Real fixed = segment.fixed / unit;
  const Real moving = segment.moving / unit;
  const Real square = fixed * fixed + moving * moving;
  const Real under = PF_REAL(2.0) * moving * moving + (ratio * ratio - PF_REAL(2.0)) * square;
  const Real root = sqrt(larger_of(under, zero));
  const Real normal = unit * (square / (PF_REAL(1.41421356237309504880) * moving + root));
  return is_point ? zero : normal;
}

/* The normal force whose theta divides the way between those of two others, of which `low` may be
 * zero (F4): at a half of `part` it is halfway, the paper's choice where they are the ends; at more
 * it is nearer to that of `low`. */
static inline Real between_thetas(Segment segment, Real low, Real high, Real part) {
  const Real zero = PF_REAL(0.0);
  const Real one = PF_REAL(1.0);
  const Real upright = ratio_on_segment(segment, high);
  const Real upright_length = length_2(one, upright);
  const Mask flat = !(low > zero);
  const Real inclined = ratio_on_segment(segment, flat ? high : low);
  const Real inclined_length = length_2(one, inclined);
  const Real flat_sine = flat ? one : inclined / inclined_length;
  const Real flat_cosine = flat ? zero : one / inclined_length;
  const Real rest = one - part;
  const Real sine = rest * (upright / upright_length) + part * flat_sine;
  const Real cosine = rest / upright_length + part * flat_cosine;
  const Real normal = normal_at_ratio(segment, sine / cosine);
  return normal < low ? low : (high < normal ? high : normal);
}
