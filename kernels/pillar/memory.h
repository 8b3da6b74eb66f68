/* Hysteresis and creep of a sensel, with few numbers that all sensels share
 * (docs/derivations/sensor_effects.md, E6). States change only while the sensel is active: what
 * they lose meanwhile follows from the number of frames since, so that idle blocks may be skipped.
 */

#define PF_MAX_PLAYS 4
#define PF_MAX_CREEPS 2
#define PF_DECAY_BITS 24

/* The states of a sensel after the frame that it was last active in, counts. */
typedef struct {
  Real play[PF_MAX_PLAYS];
  Real creep[PF_MAX_CREEPS];
} Memory;

/* The inverse of SenselMemory: V = r + sum of weight * play with r = reading - sum of weight *
 * creep. Unused weights are zero. */
typedef struct {
  float play_width[PF_MAX_PLAYS];
  float play_weight[PF_MAX_PLAYS];
  float creep_rate[PF_MAX_CREEPS]; /* part of the way to V in one frame */
  float creep_weight[PF_MAX_CREEPS];
  int plays;
  int creeps;
} MemoryModel;

/* (1 - rate)^frames, for a whole number of frames; zero from 2^24 on. */
static inline Real decay_over(Real frames, float rate) {
  const Real zero = PF_REAL(0.0);
  const Real one_half = PF_REAL(0.5);
  Real decay = PF_REAL(1.0);
  Real factor = PF_REAL(1.0) - PF_CONSTANT(Real, rate);
  Real left = frames;
  for (int bit = 0; bit < PF_DECAY_BITS; ++bit) {
    const Real lower = floor(left * one_half);
    decay = left > lower + lower ? decay * factor : decay;
    factor = factor * factor;
    left = lower;
  }
  return left > zero ? zero : decay;
}

/* The one-sided play operator: the state stays between reading - width and the reading, and above
 * zero. */
static inline Real play_after(Real before, Real reading, Real width) {
  const Real lower = reading - width;
  const Real held = before < reading ? before : reading;
  const Real raised = held > lower ? held : lower;
  return raised > PF_REAL(0.0) ? raised : PF_REAL(0.0);
}

/* States after `idle` frames without load. */
static inline Memory rested(Memory before, MemoryModel model, Real idle) {
  const Real zero = PF_REAL(0.0);
  const Mask rests = idle > zero;
  if (!any_lane(rests)) return before;
  for (int i = 0; i < model.plays; ++i) before.play[i] = rests ? zero : before.play[i];
  for (int i = 0; i < model.creeps; ++i) {
    before.creep[i] = before.creep[i] * decay_over(idle, model.creep_rate[i]);
  }
  return before;
}

/* A sensel without hysteresis and creep, and its states after this frame, which hold if it is
 * active in it. */
typedef struct {
  Sensel sensel;
  Memory memory;
  Mask active;
} Recalled;

/* Removes hysteresis and creep from a sensel that was last active `idle` frames before the last
 * one. */
static inline Recalled recall(Sensel sensel, Memory stored, MemoryModel model, Real threshold,
                              Real idle) {
  const Real zero = PF_REAL(0.0);
  const Memory before = rested(stored, model, idle);
  Recalled result;
  result.memory = before;
  Real held = zero;
  Real crept = zero;
  for (int i = 0; i < model.creeps; ++i) {
    crept = crept + PF_CONSTANT(Real, model.creep_weight[i]) * before.creep[i];
  }
  const Real fast = sensel.reading - crept;
  for (int i = 0; i < model.plays; ++i) {
    const Real play = play_after(before.play[i], fast, PF_CONSTANT(Real, model.play_width[i]));
    result.memory.play[i] = play;
    held = held + PF_CONSTANT(Real, model.play_weight[i]) * play;
  }
  const Real load = fast + held;
  for (int i = 0; i < model.creeps; ++i) {
    result.memory.creep[i] =
        before.creep[i] + PF_CONSTANT(Real, model.creep_rate[i]) * (load - before.creep[i]);
  }
  result.active = (load > threshold) && !sensel.missing;
  result.sensel = sensel;
  result.sensel.reading = load;
  return result;
}
