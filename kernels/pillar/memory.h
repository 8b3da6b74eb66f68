/* Hysteresis and creep of the sensels under a pillar, with few numbers that all sensels share
 * (docs/derivations/sensor_effects.md, E6). States change only while the pillar is touched: what
 * they lose meanwhile follows from the number of frames since, so that idle blocks may be skipped.
 */

#define PF_MAX_STATES                                                        \
  (PF_MAX_PLAYS + PF_MAX_CREEPS) /* places of a sensel's states, plays first \
                                  */

#if !defined(__cplusplus) || PF_PRECISION == 32

/* Number of the state with this place among those that a model has; -1 if it has none there. */
PF_INLINE int number_of_state(int place, MemoryModel model) {
  if (place < PF_MAX_PLAYS) return place < model.plays ? place : -1;
  return place - PF_MAX_PLAYS < model.creeps ? place - PF_MAX_PLAYS + model.plays : -1;
}

/* The states of a sensel, counts. */
typedef struct {
  Real at[PF_MAX_STATES];
} States;

/* The states of a pillar in memory: the last frame that it was touched in, and a pair of each state
 * for its upper (row 0) and its lower sensels. */
typedef struct {
  Word last;
  Word pair[2][PF_MAX_STATES];
} Memory;

/* States are not negative. Their upper 16 bits below the sign are stored, 8 of them of the
 * fraction, with the left sensel in the lower half. `dither`, below 2^15, is added before the other
 * bits are cut: it is even over the frames, so that states which move by less than their last bit
 * in a frame do so on average. */
PF_INLINE Word pair_of(Real left, Real right, Word dither) {
  return ((word_of(left) + dither) >> PF_WORD(15)) |
         (((word_of(right) + dither) << PF_WORD(1)) & PF_WORD(0xffff0000));
}
PF_INLINE Real left_of_pair(Word pair) {
  return real_of_word((pair & PF_WORD(0xffff)) << PF_WORD(15));
}
PF_INLINE Real right_of_pair(Word pair) {
  return real_of_word((pair & PF_WORD(0xffff0000)) >> PF_WORD(1));
}

/* Multiples of the golden ratio. */
PF_INLINE Word dither_of(Word frame) { return frame * PF_WORD(0x9e3779b9) >> PF_WORD(17); }

/* exp(-x) for x >= 0, to 1e-7 up to x = 2 and to 3e-3 of it up to x = 32; zero beyond. */
PF_INLINE Real decay_of(Real x) {
  const Real y = x * PF_REAL(0.00390625); /* 1 / 256 */
  const Real cubic = PF_REAL(0.5) - y * PF_REAL(0.16666666666666666667);
  Real decay = PF_REAL(1.0) - y * (PF_REAL(1.0) - y * cubic);
  PF_UNROLL
  for (int i = 0; i < 8; ++i) decay = decay * decay;
  return x < PF_REAL(32.0) ? decay : PF_REAL(0.0);
}

/* The memory of a pillar after `idle` frames without load: plays end, creep decays. */
PF_INLINE Memory rested(Memory memory, MemoryModel model, Real idle, Word dither) {
  const Mask rests = idle > PF_REAL(0.0);
  PF_UNROLL
  for (int row = 0; row < 2; ++row) {
    PF_UNROLL
    for (int i = 0; i < PF_MAX_PLAYS; ++i) {
      memory.pair[row][i] = rests ? PF_WORD(0) : memory.pair[row][i];
    }
    PF_UNROLL
    for (int i = 0; i < PF_MAX_CREEPS; ++i) {
      if (i >= model.creeps) continue;
      const Real left = decay_of(idle * PF_CONSTANT(Real, model.creep_decay[i]));
      const Word pair = memory.pair[row][PF_MAX_PLAYS + i];
      const Word after = pair_of(left * left_of_pair(pair), left * right_of_pair(pair), dither);
      memory.pair[row][PF_MAX_PLAYS + i] = rests ? after : pair;
    }
  }
  return memory;
}

/* Only a sensel whose V before this stage is above the threshold has a load. */
PF_INLINE Mask is_touched(Sensel sensel, Real threshold) {
  return (sensel.reading > threshold) && !sensel.missing;
}

PF_INLINE Mask is_touched_pillar(Pillar pillar, Real threshold) {
  return is_touched(pillar.s1, threshold) || is_touched(pillar.s2, threshold) ||
         is_touched(pillar.s3, threshold) || is_touched(pillar.s4, threshold);
}

/* The one-sided play operator: the state stays between reading - width and the reading, both not
 * negative. */
PF_INLINE Real play_after(Real before, Real reading, Real width) {
  const Real lower = reading - width;
  const Real held = before < reading ? before : reading;
  return held > lower ? held : lower;
}

/* A sensel without hysteresis and creep, which reads zero unless it is touched, and its states
 * after the frame. */
typedef struct {
  Sensel sensel;
  States states;
} RecalledSensel;

PF_INLINE RecalledSensel recall_sensel(Sensel sensel, States states, MemoryModel model,
                                       Real threshold) {
  const Real zero = PF_REAL(0.0);
  Real fast = sensel.reading;
  PF_UNROLL
  for (int i = 0; i < PF_MAX_CREEPS; ++i) {
    if (i >= model.creeps) continue;
    fast = fast - PF_CONSTANT(Real, model.creep_weight[i]) * states.at[PF_MAX_PLAYS + i];
  }
  fast = (is_touched(sensel, threshold) && (fast > zero)) ? fast : zero;
  Real load = fast;
  PF_UNROLL
  for (int i = 0; i < PF_MAX_PLAYS; ++i) {
    if (i >= model.plays) continue;
    states.at[i] = play_after(states.at[i], fast, PF_CONSTANT(Real, model.play_width[i]));
    load = load + PF_CONSTANT(Real, model.play_weight[i]) * states.at[i];
  }
  PF_UNROLL
  for (int i = 0; i < PF_MAX_CREEPS; ++i) {
    if (i >= model.creeps) continue;
    const Real creep = states.at[PF_MAX_PLAYS + i];
    const Real rate = PF_CONSTANT(Real, model.creep_rate[i]);
    states.at[PF_MAX_PLAYS + i] = creep + rate * (load - creep);
  }
  sensel.reading = load;
  const RecalledSensel result = {sensel, states};
  return result;
}

/* The states of the left (side 0) or right sensels of a row. */
PF_INLINE States states_of(Memory memory, int row, int side) {
  States states;
  PF_UNROLL
  for (int i = 0; i < PF_MAX_STATES; ++i) {
    const Word pair = memory.pair[row][i];
    states.at[i] = side == 0 ? left_of_pair(pair) : right_of_pair(pair);
  }
  return states;
}

/* A pillar's sensels without hysteresis and creep, and its memory after the frame. */
typedef struct {
  Pillar pillar;
  Memory memory;
} Recalled;

/* Removes hysteresis and creep in the frame of this number, from 1 on. */
PF_INLINE Recalled recall(Pillar pillar, Memory stored, MemoryModel model, Real threshold,
                          Word frame) {
  const Mask touched = is_touched_pillar(pillar, threshold);
  const Word dither = dither_of(frame);
  const Real idle = real_of_count(frame - stored.last - PF_WORD(1));
  Memory memory = stored;
  if (any_lane(touched && (idle > PF_REAL(0.0)))) memory = rested(stored, model, idle, dither);
  const RecalledSensel s1 = recall_sensel(pillar.s1, states_of(memory, 0, 1), model, threshold);
  const RecalledSensel s2 = recall_sensel(pillar.s2, states_of(memory, 0, 0), model, threshold);
  const RecalledSensel s3 = recall_sensel(pillar.s3, states_of(memory, 1, 0), model, threshold);
  const RecalledSensel s4 = recall_sensel(pillar.s4, states_of(memory, 1, 1), model, threshold);
  PF_UNROLL
  for (int i = 0; i < PF_MAX_STATES; ++i) {
    const Word upper = pair_of(s2.states.at[i], s1.states.at[i], dither);
    const Word lower = pair_of(s3.states.at[i], s4.states.at[i], dither);
    memory.pair[0][i] = touched ? upper : stored.pair[0][i];
    memory.pair[1][i] = touched ? lower : stored.pair[1][i];
  }
  memory.last = touched ? frame : stored.last;
  const Recalled result = {{s1.sensel, s2.sensel, s3.sensel, s4.sensel}, memory};
  return result;
}

#endif
