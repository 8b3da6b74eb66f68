/* Ratios of shear to normal force, counted, and whether many of them are one: the friction of
 * pillars that slip (docs/derivations/field.md, section 5). */

/* Bins follow a float's bits: 64 between powers of two, from 1/2 to 32. The first takes all that is
 * less; two more take what is more, and what no ratio can be told of. */
#define PF_RATIO_BINS 384u
#define PF_RATIO_BEYOND 384u
#define PF_RATIO_NONE 385u
#define PF_RATIO_PILLARS 386u /* how many pillars were counted, whatever their weight */
#define PF_RATIO_COUNTS 387u
#define PF_RATIO_SHIFT 17
#define PF_RATIO_FIRST 0x3f000000u

static inline uint bin_of_ratio(float ratio) {
  const uint bits = bits_of_float(ratio);
  if (!(ratio >= 0.5f)) return 0;
  const uint bin = (bits - PF_RATIO_FIRST) >> PF_RATIO_SHIFT;
  return bin < PF_RATIO_BINS ? bin : PF_RATIO_BEYOND;
}

/* The least ratio of a bin. */
static inline float ratio_of_bin(uint bin) {
  return float_of_bits(PF_RATIO_FIRST + (bin << PF_RATIO_SHIFT));
}

/* A ratio that many share. */
typedef struct {
  double ratio;
  double share;  /* of all counts */
  double above;  /* share beyond the window */
  double far;    /* share beyond a quarter more than the ratio */
  double spread; /* how far the ratios of the window are from it, relative */
} Plateau;

static inline void clear_counts(PF_GLOBAL uint* counts, Share share) {
  for (uint bin = share.first; bin < PF_RATIO_COUNTS; bin += share.step) counts[bin] = 0;
}

/* Counts from a bin on, with what is beyond all of them. */
static inline double counts_from(PF_GLOBAL const uint* counts, uint first) {
  double sum = (double)counts[PF_RATIO_BEYOND];
  for (uint bin = first; bin < PF_RATIO_BINS; ++bin) sum += (double)counts[bin];
  return sum;
}

/* A window of bins, and what is in it. */
typedef struct {
  uint first;
  uint end;
  double counts;
} Window;

/* Of the windows within [first, end) whose largest ratio is `width` times the least, the one that
 * holds most counts; the lower of two alike. */
static inline Window fullest_window(PF_GLOBAL const uint* counts, uint first, uint end,
                                    float width) {
  Window best = {first, first, 0.0};
  uint reached = first;
  double within = 0.0;
  for (uint bin = first; bin < end; ++bin) {
    const uint reach = bin_of_ratio(ratio_of_bin(bin) * width);
    while (reached < reach && reached < end) within += (double)counts[reached++];
    if (within > best.counts) {
      best.first = bin;
      best.end = reached;
      best.counts = within;
    }
    within -= (double)counts[bin];
  }
  return best;
}

/* Mean and standard deviation of the ratios in a window. */
typedef struct {
  double mean;
  double deviation;
} Spread;

static inline Spread spread_of(PF_GLOBAL const uint* counts, Window window) {
  double sum = 0.0;
  double squares = 0.0;
  for (uint bin = window.first; bin < window.end; ++bin) {
    const double middle = 0.5 * ((double)ratio_of_bin(bin) + (double)ratio_of_bin(bin + 1));
    sum += (double)counts[bin] * middle;
    squares += (double)counts[bin] * middle * middle;
  }
  Spread spread;
  spread.mean = sum / window.counts;
  const double variance = squares / window.counts - spread.mean * spread.mean;
  spread.deviation = variance > 0.0 ? sqrt(variance) : 0.0;
  return spread;
}

/* The plateau of the counts: the window of `width` that holds most of them says how many share it,
 * and within its reach a narrower one which ratio it is (F10). Share zero where nothing was
 * counted. */
static inline Plateau find_plateau(PF_GLOBAL const uint* counts, float width) {
  const double total = (double)counts[0] + (double)counts[PF_RATIO_NONE] + counts_from(counts, 1);
  Plateau plateau = {0.0, 0.0, 0.0, 0.0, 0.0};
  const Window wide = fullest_window(counts, 1, PF_RATIO_BINS, width);
  if (!(wide.counts > 0.0)) return plateau;
  const Spread all = spread_of(counts, wide);
  const uint last = bin_of_ratio((float)(1.127 * all.mean));
  const Window narrow =
      fullest_window(counts, wide.first, last < PF_RATIO_BINS ? last : PF_RATIO_BINS, 1.0618f);
  plateau.ratio = narrow.counts > 0.0 ? spread_of(counts, narrow).mean : all.mean;
  plateau.spread = (all.deviation + fabs(plateau.ratio - all.mean)) / all.mean;
  plateau.share = wide.counts / total;
  plateau.above = counts_from(counts, wide.end) / total;
  const uint far = bin_of_ratio((float)(1.25 * all.mean));
  plateau.far = counts_from(counts, far < PF_RATIO_BINS ? far : PF_RATIO_BINS) / total;
  return plateau;
}
