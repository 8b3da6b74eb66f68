/* The response curve of all sensels (docs/derivations/sensor_effects.md, E1): a table of V at
 * PF_CURVE_PIECES + 1 equidistant readings from zero on. */

#ifndef PF_CURVE_PIECES
#define PF_CURVE_PIECES 1024
#endif

/* A reading's piece of the table. */
typedef struct {
  Real piece;    /* index of its lower end, a whole number */
  Real fraction; /* position in the piece; above 1 beyond the end of the table */
} CurvePlace;

/* `per_count` is the number of pieces of one count. */
static inline CurvePlace curve_place(Real reading, Real per_count) {
  const Real last = PF_REAL(1.0) * (PF_CURVE_PIECES - 1);
  const Real at = reading > PF_REAL(0.0) ? reading * per_count : PF_REAL(0.0);
  CurvePlace place;
  place.piece = at < last ? floor(at) : last;
  place.fraction = at - place.piece;
  return place;
}

/* V of a reading above zero, from both ends of its piece; `largest` counts at most. A reading of
 * zero and less stays. */
static inline Sensel apply_curve(Sensel sensel, CurvePlace place, Real low, Real high,
                                 Real largest) {
  const Real load = low + place.fraction * (high - low);
  const Real bounded = load < largest ? load : largest;
  sensel.reading = sensel.reading > PF_REAL(0.0) ? bounded : sensel.reading;
  return sensel;
}
