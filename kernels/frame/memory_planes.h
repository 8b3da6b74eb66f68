/* States of the sensels under PF_LANES pillars in memory: planes of the calibration from
 * PF_MEMORY_PLANE on: plays, creep, and the number of the frame that a sensel was last active in.
 * solve_frame.cl updates them; each lane is written by its own block. Stage PF_MEMORY. */
#ifdef PF_MEMORY

PF_INLINE MemoryModel memory_model(void) {
  const MemoryModel model = {PF_PLAY_WIDTHS,   PF_PLAY_WEIGHTS, PF_CREEP_RATES, PF_CREEP_DECAYS,
                             PF_CREEP_WEIGHTS, PF_PLAYS,        PF_CREEPS};
  return model;
}

PF_INLINE global float* state_plane(Calibration calibration, int state, Place place) {
  return (global float*)PF_PLANE_OF(calibration, float, (size_t)(PF_MEMORY_PLANE + state)) +
         offset_of(calibration, place);
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

/* Removes hysteresis and creep from one row of sensels; updates the states of `lanes`. */
PF_INLINE SenselPair recall_row(SenselPair sensels, Calibration calibration, Place place,
                                Lanes lanes) {
  const Real threshold = (Real)(PF_THRESHOLD);
  const int states = PF_PLAYS + PF_CREEPS;
  const RealPair last = load_plane(state_plane(calibration, states, place));
  Memory left;
  Memory right;
  for (int i = 0; i < states; ++i) {
    const RealPair pair = load_plane(state_plane(calibration, i, place));
    if (i < PF_PLAYS) {
      left.play[i] = pair.left;
      right.play[i] = pair.right;
    } else {
      left.creep[i - PF_PLAYS] = pair.left;
      right.creep[i - PF_PLAYS] = pair.right;
    }
  }
  const Recalled to_left = recall(sensels.left, left, memory_model(), threshold,
                                  idle_frames(last.left, calibration.frame));
  const Recalled to_right = recall(sensels.right, right, memory_model(), threshold,
                                   idle_frames(last.right, calibration.frame));
  for (int i = 0; i < states; ++i) {
    RealPair pair;
    if (i < PF_PLAYS) {
      pair.left = to_left.active ? to_left.memory.play[i] : left.play[i];
      pair.right = to_right.active ? to_right.memory.play[i] : right.play[i];
    } else {
      pair.left = to_left.active ? to_left.memory.creep[i - PF_PLAYS] : left.creep[i - PF_PLAYS];
      pair.right =
          to_right.active ? to_right.memory.creep[i - PF_PLAYS] : right.creep[i - PF_PLAYS];
    }
    store_pair(pair, state_plane(calibration, i, place), lanes);
  }
  const RealPair now = {last_frame(last.left, to_left.active, calibration.frame),
                        last_frame(last.right, to_right.active, calibration.frame)};
  store_pair(now, state_plane(calibration, states, place), lanes);
  const SenselPair result = {to_left.sensel, to_right.sensel};
  return result;
}

#endif
