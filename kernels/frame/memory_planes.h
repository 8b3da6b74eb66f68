/* States of the sensels under PF_LANES pillars in memory, behind the planes of the calibration:
 * plays, creep, and the number of the frame that a sensel was last active in. Each row of sensels
 * has a line of each state for its left sensels and one for its right sensels. solve_frame.cl
 * updates them; each lane is written by its own block. Stage PF_MEMORY. */
#ifdef PF_MEMORY

#define PF_STATES (PF_PLAYS + PF_CREEPS + 1)

PF_INLINE MemoryModel memory_model(void) {
  const MemoryModel model = {PF_PLAY_WIDTHS,   PF_PLAY_WEIGHTS, PF_CREEP_RATES, PF_CREEP_DECAYS,
                             PF_CREEP_WEIGHTS, PF_PLAYS,        PF_CREEPS};
  return model;
}

/* Floats of a state of one side of a row of sensels: with skew, a multiple of a cache line. */
PF_INLINE size_t state_pitch(size_t stride) { return (stride / 2 + 31) / 16 * 16; }

/* State `state` of the left (side 0) or right (side 1) sensels of a row of a block. Aligned blocks
 * are aligned here too. */
PF_INLINE global float* state_at(Calibration calibration, int state, int side, Place place,
                                 Block block) {
  const uint col = place.col / 2;
  const size_t skew = (block.index - col) % PF_LANES;
  const size_t line = (size_t)place.row * (2 * PF_STATES) + 2 * state + side;
  return (global float*)PF_PLANE_OF(calibration, float, (size_t)PF_MEMORY_PLANE) +
         line * state_pitch(calibration.stride) + skew + col;
}

PF_INLINE RealPair load_states(Calibration calibration, int state, Place place, Block block) {
  global const float* const left = state_at(calibration, state, 0, place, block);
  global const float* const right = state_at(calibration, state, 1, place, block);
#if PF_LANES == 1
  const RealPair pair = {*left, *right};
#else
  const RealPair pair = {PF_LOAD_WHOLE(float, left), PF_LOAD_WHOLE(float, right)};
#endif
  return pair;
}

PF_INLINE void store_state(Real value, global float* to, Lanes lanes) {
#if PF_LANES == 1
  *to = value;
#else
  if (are_all(lanes)) {
    PF_STORE_WHOLE(float, value, to);
    return;
  }
  float values[PF_LANES];
  PF_VSTORE(value, 0, values);
  for (uint i = lanes.first; i < lanes.end; ++i) to[i] = values[i];
#endif
}

PF_INLINE void store_states(RealPair pair, Calibration calibration, int state, Place place,
                            Block block) {
  store_state(pair.left, state_at(calibration, state, 0, place, block), block.lanes);
  store_state(pair.right, state_at(calibration, state, 1, place, block), block.lanes);
}

#if PF_LANES == 1
#define PF_REAL_OF_WORD(word) ((Real)(word))
#else
#define PF_REAL_OF_WORD(word) PF_JOIN(convert_float, PF_LANES)(word)
#endif

/* Frames without load of a sensel that was last active in the frame whose bits are `last`. */
PF_INLINE Real idle_frames(Real last, uint now) {
  return PF_REAL_OF_WORD((Word)(now)-word_of(last) - (Word)(1u));
}

PF_INLINE Real last_frame(Real before, Mask active, uint now) {
  return active ? real_of_word((Word)(now)) : before;
}

/* Removes hysteresis and creep from one row of sensels of a block; updates the states of its
 * lanes. */
PF_INLINE SenselPair recall_row(SenselPair sensels, Calibration calibration, Place place,
                                Block block) {
  const Real threshold = (Real)(PF_THRESHOLD);
  if (!any_lane(is_touched(sensels.left, threshold) || is_touched(sensels.right, threshold))) {
    return sensels;
  }
  const RealPair last = load_states(calibration, PF_STATES - 1, place, block);
  Memory left;
  Memory right;
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair pair = load_states(calibration, i, place, block);
    left.play[i] = pair.left;
    right.play[i] = pair.right;
  }
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair pair = load_states(calibration, PF_PLAYS + i, place, block);
    left.creep[i] = pair.left;
    right.creep[i] = pair.right;
  }
  const Recalled to_left = recall(sensels.left, left, memory_model(), threshold,
                                  idle_frames(last.left, calibration.frame));
  const Recalled to_right = recall(sensels.right, right, memory_model(), threshold,
                                   idle_frames(last.right, calibration.frame));
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair pair = {to_left.active ? to_left.memory.play[i] : left.play[i],
                           to_right.active ? to_right.memory.play[i] : right.play[i]};
    store_states(pair, calibration, i, place, block);
  }
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair pair = {to_left.active ? to_left.memory.creep[i] : left.creep[i],
                           to_right.active ? to_right.memory.creep[i] : right.creep[i]};
    store_states(pair, calibration, PF_PLAYS + i, place, block);
  }
  const RealPair now = {last_frame(last.left, to_left.active, calibration.frame),
                        last_frame(last.right, to_right.active, calibration.frame)};
  store_states(now, calibration, PF_STATES - 1, place, block);
  const SenselPair result = {to_left.sensel, to_right.sensel};
  return result;
}

#endif
