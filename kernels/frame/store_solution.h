/* Writes the results of a block: all its planes together. */

#if PF_LANES > 1 && (defined(PF_PILLAR_LEAK) || defined(PF_LEAN))
/* solve_frame corrects rows itself: correct_forces.cl. */
#define PF_FUSED
#endif

/* Lanes of the block at `col` that no other block of its row writes. `place` is its aligned
 * beginning, counted from `skew` pillars before the row. */
PF_INLINE Lanes own_lanes(uint place, uint skew, uint col, uint cols) {
  const uint first = max(place, skew) - skew;
  const uint end = min(place + PF_LANES - skew, cols);
  const Lanes lanes = {first - col, end - col};
  return lanes;
}

#define PF_STORE(name, unit, value)                                          \
  store_plane(solution.value, (global float*)(plane) + index, lanes, again); \
  plane += output.plane_bytes;

/* Writes what is derived from the forces of `lanes`, lane 0 at pillar `index`; `again` as for
 * store_plane. */
PF_INLINE void store_derived(Solution solution, Output output, size_t index, Lanes lanes,
                             bool again) {
#if defined(PF_ANGLES) || defined(PF_UNCERTAINTY)
  global uchar* plane = output.planes + 3 * output.plane_bytes;
#endif
#ifdef PF_ANGLES
  PF_ANGLE_PLANES(PF_STORE)
#endif
#ifdef PF_UNCERTAINTY
  PF_UNCERTAINTY_PLANES(PF_STORE)
#endif
}

/* Writes the results of `lanes`. */
PF_INLINE void store_lanes(Solution solution, Output output, size_t index, Lanes lanes) {
#ifdef PF_FUSED
  const bool again = true;
#else
  const bool again = false;
#endif
  global uchar* plane = output.forces;
  PF_FORCE_PLANES(PF_STORE)
  store_derived(solution, output, index, lanes, again);
  store_status(solution.status, output.status + index, lanes);
}
#undef PF_STORE

/* Writes the results of a block; tests once for all planes whether the block is whole. */
PF_INLINE void store_solution(Solution solution, Output output, size_t index, Lanes lanes) {
  const Lanes whole = {0, PF_LANES};
  if (are_all(lanes)) {
    store_lanes(solution, output, index, whole);
  } else {
    store_lanes(solution, output, index, lanes);
  }
}
