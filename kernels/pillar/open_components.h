/* What saturated sensels leave open of the force of a pillar (docs/derivations/uncertainty.md, U11,
 * U12): a saturated sensel bears its reading or more. */

static inline Mask any_saturated(Pillar pillar) {
  return pillar.s1.saturated || pillar.s2.saturated || pillar.s3.saturated || pillar.s4.saturated;
}

/* True if both sensels of a diagonal are usable, so that it measures the parity sum. */
static inline Mask both_usable(Sensel p, Sensel q) { return p.usable && q.usable; }

/* Half the range of V_p - V_q of a diagonal of two saturated sensels, counts (U12). */
static inline Real hidden_difference(Sensel p, Sensel q, Mask measured, Real sum) {
  const Real rest = sum - (p.reading + q.reading);
  return (measured && p.saturated && q.saturated && rest > PF_REAL(0.0)) ? rest : PF_REAL(0.0);
}

/* What saturated sensels leave open: components without a bound, and half the range of the
 * differences over the diagonals, counts. */
typedef struct {
  Mask shear_x;
  Mask shear_y;
  Mask normal;
  Real difference;
} Open;

/* The components that the readings of a pillar with saturated sensels do not bound (U11, U12). */
static inline Open open_components(Pillar pillar, Diagonals diagonals, ParitySum sum) {
  const Sensel s1 = pillar.s1;
  const Sensel s2 = pillar.s2;
  const Sensel s3 = pillar.s3;
  const Sensel s4 = pillar.s4;
  const Diagonal a = diagonals.rising;
  const Diagonal b = diagonals.falling;
  const Mask saturated = any_saturated(pillar);
  const Mask by_a = both_usable(s1, s3);
  const Mask by_b = both_usable(s2, s4);
  const Mask a_bounds = !(s1.saturated || s3.saturated || a.unbounded);
  const Mask b_bounds = !(s2.saturated || s4.saturated || b.unbounded);
  const Mask a_is_less = a.p + a.q <= b.p + b.q;
  const Mask bounded = sum.ambiguous && ((a_bounds && a_is_less) || (b_bounds && !a_is_less));
  const Mask both =
      (by_b && s1.saturated && s3.saturated) || (by_a && s2.saturated && s4.saturated);
  Open open;
  open.normal = saturated && !(by_a || by_b || bounded);
  open.shear_x = saturated && !(both || both_usable(s1, s2) || both_usable(s3, s4));
  open.shear_y = saturated && !(both || both_usable(s1, s4) || both_usable(s2, s3));
  open.difference =
      hidden_difference(s1, s3, by_b, sum.point) + hidden_difference(s2, s4, by_a, sum.point);
  return open;
}

/* Adds what saturated sensels leave open to the deviations of the components. */
static inline Force open_deviations(Force deviations, Open open, ForceScale scale) {
  const Real hidden = scale.shear * (PF_REAL(0.57735026918962576451) * open.difference);
  const Mask is_hidden = hidden > PF_REAL(0.0);
  const Real shear_x = is_hidden ? plain_length_2(deviations.shear_x, hidden) : deviations.shear_x;
  const Real shear_y = is_hidden ? plain_length_2(deviations.shear_y, hidden) : deviations.shear_y;
  deviations.shear_x = open.shear_x ? PF_INFINITY : shear_x;
  deviations.shear_y = open.shear_y ? PF_INFINITY : shear_y;
  deviations.normal = open.normal ? PF_INFINITY : deviations.normal;
  return deviations;
}
