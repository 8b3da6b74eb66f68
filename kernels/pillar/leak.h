/* Removes the leak between neighbouring sensels by the inverse of SenselLeak, cut to the 3 x 3
 * sensels around (docs/derivations/sensor_effects.md, E3). */

/* The offset from a row or column of sensels to the one under the same pillar. A neighbour in that
 * direction is inside; one in the opposite direction, under another pillar, is across. */
PF_INLINE int inward(int at) { return (at & 1) == 0 ? 1 : -1; }

/* Weights of a sensel and of its eight neighbours. */
typedef struct {
  Real self;
  Real inside;
  Real across;
  Real both_inside; /* diagonal neighbours */
  Real mixed;
  Real both_across;
} LeakTaps;

/* V of the neighbours of one sensel: first the horizontal direction, then the vertical one. */
typedef struct {
  Real inside_h;
  Real inside_v;
  Real across_h;
  Real across_v;
  Real both_inside;
  Real inside_across;
  Real across_inside;
  Real both_across;
} Neighbours;

/* An initialiser of Neighbours: `at` gives V by offsets down and right, `in_v` and `in_h` are
 * inward() of the sensel's row and column. */
#define PF_NEIGHBOURS(at, in_v, in_h)                                                            \
  {                                                                                              \
    at(0, in_h), at(in_v, 0), at(0, -(in_h)), at(-(in_v), 0), at(in_v, in_h), at(-(in_v), in_h), \
        at(in_v, -(in_h)), at(-(in_v), -(in_h))                                                  \
  }

/* The reading that a sensel leaks: zero up to the threshold, so that noise does not spread and idle
 * sensels stay idle. */
PF_INLINE Real leak_source(Sensel sensel, Real threshold) {
  return (sensel.reading > threshold && !sensel.missing) ? sensel.reading : PF_REAL(0.0);
}

/* A missing sensel is taken to leak what its neighbour `beside` does. */
PF_INLINE Real source_or(Sensel sensel, Real source, Real beside) {
  return (sensel.missing && !sensel.absent) ? beside : source;
}

/* Subtracts what an active sensel receives; an inactive one stays inactive. */
PF_INLINE Sensel remove_leak(Sensel sensel, Neighbours v, LeakTaps taps, Real threshold) {
  const Real edges =
      taps.inside * (v.inside_h + v.inside_v) + taps.across * (v.across_h + v.across_v);
  const Real corners = taps.both_inside * v.both_inside +
                       taps.mixed * (v.inside_across + v.across_inside) +
                       taps.both_across * v.both_across;
  const Real freed = taps.self * sensel.reading + (edges + corners);
  sensel.reading = sensel.reading > threshold ? freed : sensel.reading;
  return sensel;
}

/* A component of a pillar's force without the leak between pillars (E4): `edges` and `corners` are
 * the sums over the four nearest and the four diagonal pillars. */
PF_INLINE Real pillar_without_leak(Real own, Real edges, Real corners, Real self, Real edge,
                                   Real corner) {
  return self * own + (edge * edges + corner * corners);
}
