/* Hysteresis and creep of a sensel, with few numbers that all sensels share
 * (docs/derivations/sensor_effects.md, E6). */

#define PF_MAX_PLAYS 4
#define PF_MAX_CREEPS 2

/* The states of a sensel, counts; all zero at rest. */
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
} MemoryModel;

/* A creep state below this many counts is at rest on an inactive sensel. */
#define PF_CREEP_REST PF_REAL(0.03125)

/* The one-sided play operator: the state stays between reading - width and the reading, and above
 * zero. */
static inline Real play_after(Real before, Real reading, Real width) {
  const Real lower = reading - width;
  const Real held = before < reading ? before : reading;
  const Real raised = held > lower ? held : lower;
  return raised > PF_REAL(0.0) ? raised : PF_REAL(0.0);
}

/* A sensel without hysteresis and creep, and its states after this frame. */
typedef struct {
  Sensel sensel;
  Memory memory;
} Recalled;

/* Removes hysteresis and creep. A missing sensel keeps its states. Readings up to the threshold
 * count as zero for the states, so that noise leaves an idle sensel at rest. */
static inline Recalled recall(Sensel sensel, Memory before, MemoryModel model, int plays,
                              int creeps, Real threshold) {
  const Real zero = PF_REAL(0.0);
  Recalled result;
  result.memory = before;
  Real held = zero;
  Real crept = zero;
  for (int i = 0; i < creeps; ++i)
    crept = crept + PF_CONSTANT(Real, model.creep_weight[i]) * before.creep[i];
  const Real fast = sensel.reading - crept;
  const Real played = fast > threshold ? fast : zero;
  for (int i = 0; i < plays; ++i) {
    const Real play = play_after(before.play[i], played, PF_CONSTANT(Real, model.play_width[i]));
    result.memory.play[i] = sensel.missing ? before.play[i] : play;
    held = held + PF_CONSTANT(Real, model.play_weight[i]) * play;
  }
  const Real load = fast + held;
  const Mask inactive = !(load > threshold);
  const Real pressed = inactive ? zero : load;
  for (int i = 0; i < creeps; ++i) {
    const Real state =
        before.creep[i] + PF_CONSTANT(Real, model.creep_rate[i]) * (pressed - before.creep[i]);
    const Real kept = (inactive && state < PF_CREEP_REST) ? zero : state;
    result.memory.creep[i] = sensel.missing ? before.creep[i] : kept;
  }
  result.sensel = sensel;
  result.sensel.reading = load;
  return result;
}
