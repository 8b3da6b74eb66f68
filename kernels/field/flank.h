/* A flank of a contact: along a row or a column, resolved pillars, and outwards from them open ones
 * as far as the contact goes. Some that stick, then such that slip: what lies between is bridged by
 * a cubic of the squared pressure, and only the scale of what slips is open
 * (docs/derivations/field.md, section 3). */

#define PF_FLANK_SIDE 6u       /* most pillars that are asked on either side of the gap, */
#define PF_FLANK_LEAST_CORE 4u /* least that are resolved, */
#define PF_FLANK_LEAST_RING 3u /* and that slip */
#define PF_FLANK_GAP 8u        /* most that stick between them */
#define PF_FLANK_FLOOR 0.001   /* deviation of a cubic from the truth, by the square of the peak */
#define PF_FLANK_BELOW 0.02    /* part by which what slips may be below the cubic, but for noise */
#define PF_CUBIC 4u            /* terms */

typedef struct {
  uint last;    /* cell of the resolved pillar beside the open ones */
  int outwards; /* from one cell to the next */
  uint core;    /* resolved pillars that are asked; none where there is no flank */
  uint open;    /* open pillars, but for one on the edge, which may be covered in part only */
} Flank;

/* By what a flank is measured. */
typedef struct {
  float friction; /* at which pillars slip */
  float noise;    /* of a reading, N */
  float peak;     /* N */
} FlankScale;

/* Normal equations of a cubic and, behind it, of the scale of what slips. */
typedef struct {
  double matrix[PF_CUBIC][PF_CUBIC];
  double right[PF_CUBIC]; /* of resolved pillars */
  double slip[PF_CUBIC];  /* of slipping ones */
  double square;          /* sums of w u^2 of resolved pillars, */
  double slip_square;     /* and of slipping ones */
  double samples;
} FlankSums;

/* The cubic is that of what is resolved, and on top the scale times that of what slips. */
typedef struct {
  double resolved[PF_CUBIC];
  double slipping[PF_CUBIC];
  double precision; /* of the scale, */
  double pull;      /* which is pull / precision by this flank alone (F18) */
  double square;    /* sum of w e^2 at scale 0 */
} FlankFit;

/* Open pillars are counted from 1, resolved ones from 0 to the other side. */
static inline uint flank_cell(Flank flank, int at) {
  return (uint)((int)flank.last + at * flank.outwards);
}

static inline double flank_place(int at) { return 0.125 * ((double)at - 4.0); }

/* The squared pressure of an open pillar that slips. */
static inline double slipping_square(Cells cells, Flank flank, uint at, FlankScale scale) {
  const Segment segment = segment_of_cell(cells, flank_cell(flank, (int)at));
  const double normal = (double)normal_at_ratio(segment, scale.friction);
  return normal * normal;
}

/* Of a squared pressure: noise, and what a cubic cannot follow. */
static inline double flank_variance(FlankScale scale, double value) {
  const double noise = (double)scale.noise;
  const double floor_of_cubic = PF_FLANK_FLOOR * (double)scale.peak * (double)scale.peak;
  return 2.0 * value * noise * noise + floor_of_cubic * floor_of_cubic;
}

static inline FlankSums no_flank_sums(void) {
  FlankSums sums;
  for (uint i = 0; i < PF_CUBIC; ++i) {
    for (uint j = 0; j < PF_CUBIC; ++j) sums.matrix[i][j] = 0.0;
    sums.right[i] = sums.slip[i] = 0.0;
  }
  sums.square = sums.slip_square = sums.samples = 0.0;
  return sums;
}

/* Adds a place's powers to the matrix, and times the value to one right side. */
static inline void add_powers(FlankSums* sums, double* right, int at, double weight, double value) {
  const double x = flank_place(at);
  const double powers[PF_CUBIC] = {1.0, x, x * x, x * x * x};
  for (uint i = 0; i < PF_CUBIC; ++i) {
    for (uint j = 0; j < PF_CUBIC; ++j) sums->matrix[i][j] += weight * powers[i] * powers[j];
    right[i] += weight * powers[i] * value;
  }
}

static inline void add_resolved(Cells cells, Flank flank, int at, FlankScale scale,
                                FlankSums* sums) {
  const double normal = (double)cells.top[flank_cell(flank, at)];
  const double value = normal * normal;
  const double weight = 1.0 / flank_variance(scale, value);
  add_powers(sums, sums->right, at, weight, value);
  sums->square += weight * value * value;
  sums->samples += 1.0;
}

/* Adds a pillar that slips, once, or takes it away, at -1. */
static inline void add_slipping(Cells cells, Flank flank, uint at, FlankScale scale, double times,
                                FlankSums* sums) {
  const double value = slipping_square(cells, flank, at, scale);
  const double weight = times / flank_variance(scale, value);
  add_powers(sums, sums->slip, (int)at, weight, value);
  sums->slip_square += weight * value * value;
  sums->samples += times;
}

/* Of the normal equations, their right sides in place of the solutions. */
static inline void eliminate_cubic(double matrix[PF_CUBIC][PF_CUBIC], double* first,
                                   double* second) {
  for (uint pivot = 0; pivot < PF_CUBIC; ++pivot) {
    const double inverse = matrix[pivot][pivot] > 0.0 ? 1.0 / matrix[pivot][pivot] : 0.0;
    for (uint row = pivot + 1; row < PF_CUBIC; ++row) {
      const double factor = matrix[row][pivot] * inverse;
      for (uint col = pivot; col < PF_CUBIC; ++col) matrix[row][col] -= factor * matrix[pivot][col];
      first[row] -= factor * first[pivot];
      second[row] -= factor * second[pivot];
    }
  }
  for (uint row = PF_CUBIC; row-- > 0;) {
    const double inverse = matrix[row][row] > 0.0 ? 1.0 / matrix[row][row] : 0.0;
    for (uint col = row + 1; col < PF_CUBIC; ++col) {
      first[row] -= matrix[row][col] * first[col];
      second[row] -= matrix[row][col] * second[col];
    }
    first[row] *= inverse;
    second[row] *= inverse;
  }
}

static inline FlankFit fit_flank(const FlankSums* sums) {
  FlankSums rest = *sums;
  for (uint i = 0; i < PF_CUBIC; ++i) rest.matrix[i][i] *= 1.0 + 1e-10;
  eliminate_cubic(rest.matrix, rest.right, rest.slip);
  FlankFit fit;
  fit.precision = sums->slip_square;
  fit.pull = 0.0;
  fit.square = sums->square;
  for (uint i = 0; i < PF_CUBIC; ++i) {
    fit.resolved[i] = rest.right[i];
    fit.slipping[i] = rest.slip[i];
    fit.precision -= sums->slip[i] * rest.slip[i];
    fit.pull += sums->slip[i] * rest.right[i];
    fit.square -= sums->right[i] * rest.right[i];
  }
  return fit;
}

/* The cubic at an open pillar, what slips taken at scale 1. */
static inline double on_flank(const FlankFit* fit, uint at) {
  const double x = flank_place((int)at);
  double sum = 0.0;
  for (uint i = PF_CUBIC; i-- > 0;) sum = sum * x + (fit->resolved[i] + fit->slipping[i]);
  return sum;
}

/* The ring that slips begins behind so many pillars that stick. */
typedef struct {
  uint gap;
  FlankSums sums;
  FlankFit fit;
} Ring;

static inline bool in_ring(Flank flank, uint gap, uint at) {
  return at > gap && at <= flank.open && at <= gap + PF_FLANK_SIDE;
}

/* Whether the pillar that the gap has next to the ring slips, too: one that sticks bears more than
 * it would in slip. */
static inline bool joins_ring(Cells cells, Flank flank, FlankScale scale, const Ring* ring) {
  const double expected = on_flank(&ring->fit, ring->gap);
  const double value = slipping_square(cells, flank, ring->gap, scale);
  const double part = expected > 0.0 ? PF_FLANK_BELOW * expected : 0.0;
  return !(value < expected - part - sqrt(flank_variance(scale, value)));
}

/* What is farthest out slips; from there the ring grows inwards, as far as pillars bear in slip
 * what the cubic has. */
static inline Ring ring_of(Cells cells, Flank flank, FlankScale scale) {
  Ring ring;
  ring.gap = flank.open - PF_FLANK_LEAST_RING;
  if (ring.gap > PF_FLANK_GAP) ring.gap = PF_FLANK_GAP;
  ring.sums = no_flank_sums();
  for (uint back = 0; back < flank.core; ++back) {
    add_resolved(cells, flank, -(int)back, scale, &ring.sums);
  }
  for (uint at = ring.gap + 1; in_ring(flank, ring.gap, at); ++at) {
    add_slipping(cells, flank, at, scale, 1.0, &ring.sums);
  }
  ring.fit = fit_flank(&ring.sums);
  while (ring.gap > 0 && joins_ring(cells, flank, scale, &ring)) {
    const uint farthest = ring.gap + PF_FLANK_SIDE;
    if (in_ring(flank, ring.gap, farthest)) {
      add_slipping(cells, flank, farthest, scale, -1.0, &ring.sums);
    }
    add_slipping(cells, flank, ring.gap, scale, 1.0, &ring.sums);
    --ring.gap;
    ring.fit = fit_flank(&ring.sums);
  }
  return ring;
}
