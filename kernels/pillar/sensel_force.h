/* The force on a sensel that is an element of its own, without a pillar: normal alone, V / k
 * (docs/derivations/direct_solve.md, section 9). */

/* Bits of its status byte: PF_STATUS_SENSEL_1 where it is usable, PF_STATUS_SATURATED, and
 * PF_STATUS_INCONSISTENT where it is missing but not absent. */
PF_INLINE Bits sensel_status(Sensel sensel) {
  return (bits_of(sensel.usable) & PF_BITS(PF_STATUS_SENSEL_1)) |
         (bits_of(sensel.saturated) & PF_BITS(PF_STATUS_SATURATED)) |
         (bits_of(sensel.missing && !sensel.absent) & PF_BITS(PF_STATUS_INCONSISTENT));
}

/* N, from newtons per count; zero where the sensel is inactive or missing, the least force where it
 * is saturated. */
PF_INLINE Real sensel_force(Sensel sensel, Real newtons_per_count) {
  return (sensel.usable || sensel.saturated) ? sensel.reading * newtons_per_count : PF_REAL(0.0);
}

/* Standard deviation of the force, N, from that of the corrected reading, counts: PF_OPEN_N where
 * the sensel is saturated or missing, zero where it is inactive or absent. */
PF_INLINE Real sensel_deviation(Sensel sensel, Real noise, Real newtons_per_count) {
  const Mask open = sensel.saturated || (sensel.missing && !sensel.absent);
  const Real known = sensel.usable ? noise * newtons_per_count : PF_REAL(0.0);
  return open ? PF_OPEN_N : bounded_n(known);
}
