/* The course of a contact: which steps resolve it, in which order
 * (docs/derivations/field.md, section 6). Each of its work-items decides alike what comes next, by
 * what was shared before. */

/* Steps. What each does is in step.h. */
#define PF_CLEAR_BOX 0u
#define PF_LOAD_BOX 1u
#define PF_SUMMARISE_LINES 2u
#define PF_SUMMARISE_BOX 3u
#define PF_CLEAR_COUNTS 4u /* before one that counts */
#define PF_COUNT_SLOPES 5u
#define PF_COUNT_CONTRADICTIONS 6u
#define PF_COUNT_IMPLIED 7u
#define PF_FIND_PLATEAU 8u
#define PF_SEE_CONTRADICTIONS 9u
#define PF_WEIGH_LINES 10u
#define PF_SUM_LINES 11u
#define PF_FIT_TREND 12u
#define PF_SUM_BORDER 13u
#define PF_SHARE_MISFIT 14u
#define PF_BEGIN_MEMBRANE 15u
#define PF_RELAX_MEMBRANE 16u
#define PF_SUM_FLANKS 17u
#define PF_SHARE_FLANKS 18u
#define PF_SHAPE_ROWS 19u
#define PF_SHAPE_COLUMNS 20u
#define PF_END_OF_COURSE 21u

/* Where a contact's course has come to. */
typedef struct {
  uint step;         /* that is to be taken */
  uint counts;       /* the step that counts, now or last */
  uint round;        /* of what is repeated */
  Verdict verdict;   /* so far */
  float known;       /* friction that resolved pillars show; zero where they show none */
  SlipEvidence slip; /* for it */
  float flanked;     /* friction of flanks */
  Choice choice;     /* of a model, */
  Fit fit;           /* its trend, */
  Plateau implied;   /* and the plateau of the ratios that it implies */
} Course;

static inline void begin_course(Course* course) {
  const Plateau none = {0.0, 0.0, 0.0, 0.0, 0.0};
  course->step = PF_CLEAR_BOX;
  course->counts = PF_COUNT_SLOPES;
  course->round = 0;
  course->verdict = verdict_by(PF_BY_NOTHING, 0.0f);
  course->known = 0.0f;
  course->slip.plateau = none;
  course->flanked = 0.0f;
  course->choice.attempt = 0;
  course->choice.best = PF_NO_MODEL;
  course->choice.merit = 0.0f;
  course->choice.spread = 0.0f;
  course->implied = none;
}

/* Leads to a step that counts. */
static inline void count_next(Course* course, uint counts) {
  course->counts = counts;
  course->step = PF_CLEAR_COUNTS;
}

/* The pressure's shape comes next, where it may be used. */
static inline void begin_shape(Course* course, FieldSettings settings) {
  course->step = settings.shape != 0 ? PF_WEIGH_LINES : PF_END_OF_COURSE;
}

static inline void after_summary(Course* course, Scratch scratch, FieldSettings settings) {
  const uint bounded = settings.friction > 0.0f ? PF_BY_BOUND : PF_BY_NOTHING;
  course->verdict = verdict_by(settings.slips != 0 ? PF_BY_FRICTION : bounded, settings.friction);
  if (settings.slips != 0 || scratch.shared[PF_AT_RESOLVED] < PF_LEAST_RESOLVED) {
    course->step = PF_END_OF_COURSE;
  } else if (settings.slip != 0) {
    count_next(course, PF_COUNT_SLOPES);
  } else {
    begin_shape(course, settings);
  }
}

/* Slopes are counted twice, the second time by what the first told. */
static inline void after_slopes(Course* course, FieldSettings settings) {
  const bool first = course->round++ == 0;
  if (first && !(course->slip.plateau.share > 0.0)) {
    begin_shape(course, settings);
  } else {
    count_next(course, first ? PF_COUNT_SLOPES : PF_COUNT_CONTRADICTIONS);
  }
}

static inline void after_contradictions(Course* course, Scratch scratch, FieldSettings settings) {
  const double loaded = scratch.shared[PF_AT_LOADED];
  const ShownFriction shown = shown_friction(&course->slip, loaded);
  const bool few = scratch.shared[PF_AT_OPEN] < PF_FEW_OPEN * loaded;
  begin_shape(course, settings);
  if (!(shown.friction > 0.0f)) return;
  course->known = shown.friction;
  course->verdict = verdict_by(PF_BY_SLIP, shown.friction);
  course->verdict.spread = shown.spread;
  course->verdict.may_stick = shown.share < PF_ALL_SLIP ? 1 : 0;
  if (course->verdict.may_stick == 0 || few) course->step = PF_END_OF_COURSE;
}

/* Tries a model; the verdict so far stays where the best is to be used and there is none. */
static inline void begin_attempt(Course* course, Scratch scratch, uint attempt) {
  course->choice.attempt = attempt;
  course->round = 0;
  if (attempt == PF_USE_BEST && course->choice.best == PF_NO_MODEL) {
    course->step = PF_END_OF_COURSE;
  } else if (asks_flanks(course->choice)) {
    course->flanked = PF_FLANK_FRICTION;
    course->step = PF_SUM_FLANKS;
  } else if (attempt == PF_USE_BEST && course->choice.best == PF_FLANKS) {
    course->step = PF_SHAPE_ROWS;
  } else if (is_relaxed(course->choice)) {
    course->fit.trend = shared_trend_of(scratch, tried_model(course->choice));
    course->step = PF_BEGIN_MEMBRANE;
  } else {
    begin_fit(tried_model(course->choice), &course->fit);
    course->step = PF_SUM_LINES;
  }
}

/* Fits once more, with the pillars that slip at a friction. */
static inline void fit_at_friction(Course* course, float friction) {
  course->fit.trend.friction = friction;
  course->fit.trend.told = course->known > 0.0f;
  course->step = PF_SUM_LINES;
}

static inline void after_fit(Course* course, Scratch scratch) {
  course->fit.trend = shared_trend_of(scratch, tried_model(course->choice));
  ++course->round;
  if (course->round < PF_FIT_ROUNDS) {
    course->step = PF_SUM_LINES;
  } else if (course->known > 0.0f && course->round < PF_FIT_ROUNDS + PF_SLIP_ROUNDS) {
    fit_at_friction(course, course->known);
  } else {
    count_next(course, PF_COUNT_IMPLIED);
  }
}

/* Flanks tell a friction, at which they are asked again; after the last round open pillars are
 * asked whether they contradict it. */
static inline void after_flanks(Course* course, Scratch scratch) {
  course->flanked = (float)shared_flanks(scratch).friction;
  ++course->round;
  if (course->round < PF_FLANK_ROUNDS) {
    course->step = PF_SUM_FLANKS;
  } else {
    count_next(course, PF_COUNT_CONTRADICTIONS);
  }
}

/* A verdict on what flanks say. */
static inline void judge_flanks(Course* course, Scratch scratch) {
  const double all = course->slip.agree + course->slip.contradict;
  const Verdict verdict =
      verdict_by_flanks(shared_flanks(scratch), all > 0.0 ? course->slip.contradict / all : 0.0);
  begin_attempt(course, scratch, attempt_after_flanks(verdict, scratch, &course->choice));
}

/* Flanks were the best. */
static inline void end_with_flanks(Course* course) {
  course->verdict = verdict_by(PF_BY_SHAPE, course->flanked);
  course->verdict.spread = course->choice.spread;
  course->step = PF_END_OF_COURSE;
}

/* A verdict on the model that was tried. */
static inline void after_attempt(Course* course, Scratch scratch) {
  const Model model = tried_model(course->choice);
  Verdict verdict = verdict_of_shape(course->implied, &course->fit.trend,
                                     scratch.shared[model.shared + PF_TREND_MISFIT]);
  if (course->choice.attempt != PF_USE_BEST) {
    begin_attempt(course, scratch, attempt_after(verdict, scratch, course->known, &course->choice));
    return;
  }
  if (course->known > 0.0f) {
    verdict.friction = course->known;
    verdict.spread = course->verdict.spread;
    verdict.may_stick = 1;
  }
  course->verdict = verdict;
  course->step = PF_END_OF_COURSE;
}

/* A trend implies a friction: unless few pillars share it, those that slip join the fit. */
static inline void after_implied(Course* course, Scratch scratch) {
  if (is_relaxed(course->choice)) {
    after_attempt(course, scratch);
  } else if (!(course->known > 0.0f) && course->round < PF_FIT_ROUNDS + PF_SLIP_ROUNDS &&
             course->implied.share > PF_LEAST_SLIP) {
    fit_at_friction(course, (float)course->implied.ratio);
  } else {
    course->step = PF_SUM_BORDER;
  }
}

/* The membrane is relaxed, then what it implies is counted. */
static inline void relax_next(Course* course, uint half_sweep, FieldSettings settings) {
  course->round = half_sweep;
  if (half_sweep < 2 * settings.sweeps) {
    course->step = PF_RELAX_MEMBRANE;
  } else {
    count_next(course, PF_COUNT_IMPLIED);
  }
}

/* Leads from the step that was taken to the one that follows. */
static inline void next_step(Course* course, Scratch scratch, FieldSettings settings) {
  switch (course->step) {
    case PF_SUMMARISE_BOX:
      after_summary(course, scratch, settings);
      break;
    case PF_CLEAR_COUNTS:
      course->step = course->counts;
      break;
    case PF_COUNT_SLOPES:
    case PF_COUNT_IMPLIED:
      course->step = PF_FIND_PLATEAU;
      break;
    case PF_COUNT_CONTRADICTIONS:
      course->step = PF_SEE_CONTRADICTIONS;
      break;
    case PF_FIND_PLATEAU:
      if (course->counts == PF_COUNT_SLOPES) {
        after_slopes(course, settings);
      } else {
        after_implied(course, scratch);
      }
      break;
    case PF_SEE_CONTRADICTIONS:
      if (asks_flanks(course->choice)) {
        judge_flanks(course, scratch);
      } else {
        after_contradictions(course, scratch, settings);
      }
      break;
    case PF_WEIGH_LINES:
      begin_attempt(course, scratch, attempt_from(0, course->choice, scratch, course->known));
      break;
    case PF_FIT_TREND:
      after_fit(course, scratch);
      break;
    case PF_SHARE_FLANKS:
      after_flanks(course, scratch);
      break;
    case PF_SHAPE_COLUMNS:
      end_with_flanks(course);
      break;
    case PF_SHARE_MISFIT:
      after_attempt(course, scratch);
      break;
    case PF_BEGIN_MEMBRANE:
      relax_next(course, 0, settings);
      break;
    case PF_RELAX_MEMBRANE:
      relax_next(course, course->round + 1, settings);
      break;
    default: /* the others come one after the other */
      ++course->step;
  }
}
