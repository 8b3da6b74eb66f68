/* Ratios of shear to normal force, counted, and whether many of them are one: the friction of
 * pillars that slip (docs/derivations/field.md, section 5). */

/* Bins follow a float's bits: 64 between powers of two, from 1/2 to 32. The first takes all that is
 * less; two more take what is more, and what no ratio can be told of. */
#define PF_RATIO_BINS 384u
#define PF_RATIO_BEYOND 384u
#define PF_RATIO_NONE 385u
#define PF_RATIO_COUNTS 386u
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
  double spread; /* standard deviation of the ratios in the window, relative */
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

/* The window of ratios, the largest `width` times the least, that holds most counts. The lower one
 * of two alike. Share zero where there are no counts. */
static inline Plateau find_plateau(PF_GLOBAL const uint* counts, float width) {
  double total = (double)counts[0] + (double)counts[PF_RATIO_NONE] + counts_from(counts, 1);
  uint end = 1;
  double within = 0.0;
  double most = 0.0;
  uint best = 0;
  uint best_end = 0;
  for (uint bin = 1; bin < PF_RATIO_BINS; ++bin) {
    const uint reach = bin_of_ratio(ratio_of_bin(bin) * width);
    while (end < reach) within += (double)counts[end++];
    if (within > most) {
      most = within;
      best = bin;
      best_end = end;
    }
    within -= (double)counts[bin];
  }
  Plateau plateau;
  plateau.ratio = 0.0;
  plateau.share = 0.0;
  plateau.above = 0.0;
  plateau.far = 0.0;
  plateau.spread = 0.0;
  if (!(most > 0.0)) return plateau;
  double sum = 0.0;
  double squares = 0.0;
  for (uint bin = best; bin < best_end; ++bin) {
    const double middle = 0.5 * ((double)ratio_of_bin(bin) + (double)ratio_of_bin(bin + 1));
    sum += (double)counts[bin] * middle;
    squares += (double)counts[bin] * middle * middle;
  }
  plateau.ratio = sum / most;
  const double variance = squares / most - plateau.ratio * plateau.ratio;
  plateau.spread = variance > 0.0 ? sqrt(variance) / plateau.ratio : 0.0;
  plateau.share = most / total;
  plateau.above = counts_from(counts, best_end) / total;
  const uint far = bin_of_ratio((float)(1.25 * plateau.ratio));
  plateau.far = counts_from(counts, far < PF_RATIO_BINS ? far : PF_RATIO_BINS) / total;
  return plateau;
}
