/* States of the sensels under PF_LANES pillars in memory, behind the planes of the calibration:
 * plays, creep, and the number of the frame that a sensel was last active in. solve_frame.cl
 * updates them; each block has its own. Stage PF_MEMORY. */
#ifdef PF_MEMORY

#define PF_STATES (PF_PLAYS + PF_CREEPS + 1)

PF_INLINE MemoryModel memory_model(void) {
  const MemoryModel model = {PF_PLAY_WIDTHS,   PF_PLAY_WEIGHTS, PF_CREEP_RATES, PF_CREEP_DECAYS,
                             PF_CREEP_WEIGHTS, PF_PLAYS,        PF_CREEPS};
  return model;
}

/* State `state` of the left (side 0) or right (side 1) sensels of a row of a block. With several
 * lanes all states of a block lie together, lane by lane, those of other blocks' lanes unused; with
 * one lane the states of a row of sensels do. */
PF_INLINE global float* state_at(Calibration calibration, int state, int side, uint row,
                                 Block block) {
  const size_t number = 2 * state + side;
  global float* const states =
      (global float*)PF_PLANE_OF(calibration, float, (size_t)PF_MEMORY_PLANE);
#if PF_LANES == 1
  return states + ((size_t)row * (2 * PF_STATES) + number) * block.blocks + block.at;
#else
  return states + (((size_t)row * block.blocks + block.at) * (2 * PF_STATES) + number) * PF_LANES;
#endif
}

PF_INLINE RealPair load_states(Calibration calibration, int state, uint row, Block block) {
  const RealPair pair = {*(global const Real*)state_at(calibration, state, 0, row, block),
                         *(global const Real*)state_at(calibration, state, 1, row, block)};
  return pair;
}

PF_INLINE void store_states(RealPair pair, Calibration calibration, int state, uint row,
                            Block block) {
  *(global Real*)state_at(calibration, state, 0, row, block) = pair.left;
  *(global Real*)state_at(calibration, state, 1, row, block) = pair.right;
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

/* Prefetches the states of both rows of the block one pillar row below. */
PF_INLINE void prefetch_states(Calibration calibration, Block block) {
#if PF_LANES > 1
  for (uint row = block.top.row + 2; row < block.top.row + 4; ++row) {
    for (int state = 0; state < PF_STATES; ++state) {
      PF_PREFETCH_FAR(state_at(calibration, state, 0, row, block));
    }
  }
#endif
}

/* Removes hysteresis and creep from one row of a block's sensels, and updates their states. */
PF_INLINE SenselPair recall_row(SenselPair sensels, Calibration calibration, uint row,
                                Block block) {
  const Real threshold = (Real)(PF_THRESHOLD);
  if (!any_lane(is_touched(sensels.left, threshold) || is_touched(sensels.right, threshold))) {
    return sensels;
  }
  const RealPair last = load_states(calibration, PF_STATES - 1, row, block);
  Memory left;
  Memory right;
  PF_UNROLL
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair pair = load_states(calibration, i, row, block);
    left.play[i] = pair.left;
    right.play[i] = pair.right;
  }
  PF_UNROLL
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair pair = load_states(calibration, PF_PLAYS + i, row, block);
    left.creep[i] = pair.left;
    right.creep[i] = pair.right;
  }
  const Recalled to_left = recall(sensels.left, left, memory_model(), threshold,
                                  idle_frames(last.left, calibration.frame));
  const Recalled to_right = recall(sensels.right, right, memory_model(), threshold,
                                   idle_frames(last.right, calibration.frame));
  PF_UNROLL
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair pair = {to_left.active ? to_left.memory.play[i] : left.play[i],
                           to_right.active ? to_right.memory.play[i] : right.play[i]};
    store_states(pair, calibration, i, row, block);
  }
  PF_UNROLL
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair pair = {to_left.active ? to_left.memory.creep[i] : left.creep[i],
                           to_right.active ? to_right.memory.creep[i] : right.creep[i]};
    store_states(pair, calibration, PF_PLAYS + i, row, block);
  }
  const RealPair now = {last_frame(last.left, to_left.active, calibration.frame),
                        last_frame(last.right, to_right.active, calibration.frame)};
  store_states(now, calibration, PF_STATES - 1, row, block);
  const SenselPair result = {to_left.sensel, to_right.sensel};
  return result;
}

#endif
