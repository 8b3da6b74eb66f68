/* What is done at each step of a contact's course. */

/* A contact, and the work-item's share of it. */
typedef struct {
  Tile tile;
  Scratch scratch;
  Field field;
  PF_GLOBAL const Run* runs; /* of all contacts of the frame */
  FieldSettings settings;
  Share share;
} Contact;

/* The plateau of what was counted last. */
static inline void see_plateau(const Contact* contact, Course* course) {
  PF_GLOBAL const uint* const counts = contact->scratch.counts;
  const bool slopes = course->counts == PF_COUNT_SLOPES;
  const float window =
      slopes ? slopes_window(contact->scratch, contact->settings.noise) : PF_IMPLIED_WINDOW;
  const Plateau plateau = find_plateau(counts, window);
  if (slopes) {
    course->slip.plateau = plateau;
    course->slip.telling = (double)counts[PF_RATIO_PILLARS];
  } else {
    course->implied = plateau;
  }
}

/* The friction that open pillars may contradict: that of slopes, later that of flanks. */
static inline float doubted_friction(const Course* course) {
  return asks_flanks(course->choice) ? course->flanked : (float)course->slip.plateau.ratio;
}

static inline FlankScale flank_scale_of(const Contact* contact, const Course* course) {
  const FlankScale scale = {course->flanked, contact->settings.noise, peak_of(contact->scratch)};
  return scale;
}

/* Takes the work-item's share of the step at hand. */
static inline void take_step(const Contact* contact, Course* course) {
  const Tile tile = contact->tile;
  const Scratch scratch = contact->scratch;
  const Cells cells = scratch.cells;
  const FieldSettings settings = contact->settings;
  const Share share = contact->share;
  const Trend trend = course->fit.trend; /* a copy, which no sum that is written can change */
  switch (course->step) {
    case PF_CLEAR_BOX:
      clear_tile(tile, cells, contact->field, share);
      break;
    case PF_LOAD_BOX:
      load_tile(tile, cells, contact->field, contact->runs, settings.segment_point, share);
      break;
    case PF_SUMMARISE_LINES:
      summarise_lines(tile, cells, scratch.lines, share);
      break;
    case PF_SUMMARISE_BOX:
      if (share.first == 0) share_summary(tile, scratch);
      break;
    case PF_CLEAR_COUNTS:
      clear_counts(scratch.counts, share);
      break;
    case PF_COUNT_SLOPES:
      count_slopes(tile, scratch, contact->field, settings.quiet, (float)course->slip.plateau.ratio,
                   share);
      break;
    case PF_COUNT_CONTRADICTIONS:
      count_contradictions(tile, scratch, settings.noise, doubted_friction(course), share);
      break;
    case PF_COUNT_IMPLIED:
      evaluate_shape(tile, scratch, &trend, is_relaxed(course->choice), settings.noise, share);
      break;
    case PF_FIND_PLATEAU:
      see_plateau(contact, course);
      break;
    case PF_SEE_CONTRADICTIONS:
      course->slip.agree = (double)scratch.counts[0];
      course->slip.contradict = (double)scratch.counts[1];
      break;
    case PF_WEIGH_LINES:
      weigh_lines(tile, cells, peak_of(scratch), share);
      break;
    case PF_SUM_LINES:
      sum_lines(tile, cells, &trend, peak_of(scratch), scratch.lines, share);
      break;
    case PF_FIT_TREND:
      if (share.first == 0) {
        fit_round(tile, scratch, tried_model(course->choice), course->round, &course->fit);
      }
      break;
    case PF_SUM_BORDER:
      sum_border(tile, cells, &trend, scratch.lines, share);
      break;
    case PF_SHARE_MISFIT:
      if (share.first == 0) share_misfit(tile, scratch, tried_model(course->choice));
      break;
    case PF_SUM_FLANKS:
      sum_flanks(tile, cells, flank_scale_of(contact, course), scratch.lines, share);
      break;
    case PF_SHARE_FLANKS:
      if (share.first == 0) share_flanks(tile, scratch, course->flanked);
      break;
    case PF_SHAPE_ROWS:
      shape_rows(tile, cells, flank_scale_of(contact, course), share);
      break;
    case PF_SHAPE_COLUMNS:
      shape_columns(tile, cells, flank_scale_of(contact, course), share);
      break;
    case PF_BEGIN_MEMBRANE:
      begin_residuals(tile, cells, &trend, peak_of(scratch), share);
      break;
    case PF_RELAX_MEMBRANE:
      relax_colour(tile, cells, course->round & 1u, share);
      break;
    default:
      break;
  }
}
