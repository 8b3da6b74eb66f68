/* States of the sensels under PF_LANES pillars in memory: planes of the calibration from
 * PF_MEMORY_PLANE on, plays before creep. solve_frame.cl updates them; each lane is written by its
 * own block. Stage PF_MEMORY. */
#ifdef PF_MEMORY

PF_INLINE MemoryModel memory_model(void) {
  const MemoryModel model = {PF_PLAY_WIDTHS, PF_PLAY_WEIGHTS, PF_CREEP_RATES, PF_CREEP_WEIGHTS};
  return model;
}

typedef struct {
  Memory left;
  Memory right;
} MemoryPair;

PF_INLINE global float* state_plane(Calibration calibration, int state, Place place) {
  return (global float*)PF_PLANE_OF(calibration, float, (size_t)(PF_MEMORY_PLANE + state)) +
         offset_of(calibration, place);
}

PF_INLINE MemoryPair load_memory(Calibration calibration, Place place) {
  MemoryPair pair;
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair states = load_plane(state_plane(calibration, i, place));
    pair.left.play[i] = states.left;
    pair.right.play[i] = states.right;
  }
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair states = load_plane(state_plane(calibration, PF_PLAYS + i, place));
    pair.left.creep[i] = states.left;
    pair.right.creep[i] = states.right;
  }
  return pair;
}

PF_INLINE void store_memory(MemoryPair pair, Calibration calibration, Place place, Lanes lanes) {
  for (int i = 0; i < PF_PLAYS; ++i) {
    const RealPair states = {pair.left.play[i], pair.right.play[i]};
    store_pair(states, state_plane(calibration, i, place), lanes);
  }
  for (int i = 0; i < PF_CREEPS; ++i) {
    const RealPair states = {pair.left.creep[i], pair.right.creep[i]};
    store_pair(states, state_plane(calibration, PF_PLAYS + i, place), lanes);
  }
}

/* Removes hysteresis and creep from one row of sensels; updates the states of `lanes`. */
PF_INLINE SenselPair recall_row(SenselPair sensels, Calibration calibration, Place place,
                                Lanes lanes) {
  const MemoryPair before = load_memory(calibration, place);
  const Real threshold = (Real)(PF_THRESHOLD);
  const Recalled left =
      recall(sensels.left, before.left, memory_model(), PF_PLAYS, PF_CREEPS, threshold);
  const Recalled right =
      recall(sensels.right, before.right, memory_model(), PF_PLAYS, PF_CREEPS, threshold);
  const MemoryPair after = {left.memory, right.memory};
  store_memory(after, calibration, place, lanes);
  const SenselPair result = {left.sensel, right.sensel};
  return result;
}

/* True if all states of a row of sensels are zero. */
PF_INLINE bool row_is_at_rest(Calibration calibration, Place place) {
  const MemoryPair states = load_memory(calibration, place);
  Real sum = (Real)(0.0f);
  for (int i = 0; i < PF_CREEPS; ++i) {
    sum = sum + fabs(states.left.creep[i]) + fabs(states.right.creep[i]);
  }
  for (int i = 0; i < PF_PLAYS; ++i) sum = sum + states.left.play[i] + states.right.play[i];
  return !any_lane(sum > (Real)(0.0f));
}

PF_INLINE bool is_at_rest(Block block, Calibration calibration) {
  return row_is_at_rest(calibration, block.top) && row_is_at_rest(calibration, block.bottom);
}

/* Flag of each block of a pillar row: its sensels have states. All slots share them. */
PF_INLINE global uchar* state_flags(Calibration calibration, uint row, uint cols) {
  return (global uchar*)PF_PLANE_OF(calibration, uchar, (size_t)(PF_STATE_FLAGS_PLANE)) +
         (size_t)row * blocks_of_row(cols);
}

#endif
