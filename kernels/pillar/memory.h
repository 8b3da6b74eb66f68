/* Hysteresis and creep of a sensel, with few numbers that all sensels share
 * (docs/derivations/sensor_effects.md, E6). States change only while the sensel is active: what
 * they lose meanwhile follows from the number of frames since, so that idle blocks may be skipped.
 */

#define PF_MAX_PLAYS 4
#define PF_MAX_CREEPS 2

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
  float creep_rate[PF_MAX_CREEPS];  /* part of the way to V in one frame */
  float creep_decay[PF_MAX_CREEPS]; /* frame interval over the time of the creep */
  float creep_weight[PF_MAX_CREEPS];
  int plays;
  int creeps;
} MemoryModel;

/* exp(-x) for x >= 0, to 1e-7 up to x = 2 and to 3e-3 of it up to x = 32; zero beyond. */
PF_INLINE Real decay_of(Real x) {
  const Real y = x * PF_REAL(0.00390625); /* 1 / 256 */
  const Real cubic = PF_REAL(0.5) - y * PF_REAL(0.16666666666666666667);
  Real decay = PF_REAL(1.0) - y * (PF_REAL(1.0) - y * cubic);
  PF_UNROLL
  for (int i = 0; i < 8; ++i) decay = decay * decay;
  return x < PF_REAL(32.0) ? decay : PF_REAL(0.0);
}

/* The one-sided play operator: the state stays between reading - width and the reading, and above
 * zero. */
PF_INLINE Real play_after(Real before, Real reading, Real width) {
  const Real lower = reading - width;
  const Real held = before < reading ? before : reading;
  const Real raised = held > lower ? held : lower;
  return raised > PF_REAL(0.0) ? raised : PF_REAL(0.0);
}

/* Only a sensel whose V before this stage is above the threshold has a load. */
PF_INLINE Mask is_touched(Sensel sensel, Real threshold) {
  return (sensel.reading > threshold) && !sensel.missing;
}

/* States of a touched sensel after `idle` frames without load; of others they do not count. */
PF_INLINE Memory rested(Memory before, MemoryModel model, Real idle, Mask touched) {
  const Real zero = PF_REAL(0.0);
  const Mask rests = (idle > zero) && touched;
  if (!any_lane(rests)) return before;
  PF_UNROLL
  for (int i = 0; i < model.plays; ++i) before.play[i] = rests ? zero : before.play[i];
  PF_UNROLL
  for (int i = 0; i < model.creeps; ++i) {
    before.creep[i] = before.creep[i] * decay_of(idle * PF_CONSTANT(Real, model.creep_decay[i]));
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
PF_INLINE Recalled recall(Sensel sensel, Memory stored, MemoryModel model, Real threshold,
                          Real idle) {
  const Real zero = PF_REAL(0.0);
  const Mask touched = is_touched(sensel, threshold);
  const Memory before = rested(stored, model, idle, touched);
  Recalled result;
  result.memory = before;
  Real held = zero;
  Real crept = zero;
  PF_UNROLL
  for (int i = 0; i < model.creeps; ++i) {
    crept = crept + PF_CONSTANT(Real, model.creep_weight[i]) * before.creep[i];
  }
  const Real fast = sensel.reading - crept;
  PF_UNROLL
  for (int i = 0; i < model.plays; ++i) {
    const Real play = play_after(before.play[i], fast, PF_CONSTANT(Real, model.play_width[i]));
    result.memory.play[i] = play;
    held = held + PF_CONSTANT(Real, model.play_weight[i]) * play;
  }
  const Real load = fast + held;
  PF_UNROLL
  for (int i = 0; i < model.creeps; ++i) {
    result.memory.creep[i] =
        before.creep[i] + PF_CONSTANT(Real, model.creep_rate[i]) * (load - before.creep[i]);
  }
  result.active = (load > threshold) && touched;
  result.sensel = sensel;
  result.sensel.reading = touched ? load : sensel.reading;
  return result;
}
