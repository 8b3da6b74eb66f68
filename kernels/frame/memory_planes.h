/* States of the sensels under PF_LANES pillars in memory (Memory), behind the planes of the
 * calibration. solve_frame.cl updates them; each block has its own. Stage PF_MEMORY. */
#ifdef PF_MEMORY

#define PF_MEMORY_WORDS (1 + 2 * (PF_PLAYS + PF_CREEPS)) /* of a pillar */

PF_INLINE MemoryModel memory_model(Stages stages) {
  MemoryModel model = PF_NUMBER(memory_model);
  model.plays = PF_PLAYS;
  model.creeps = PF_CREEPS;
  return model;
}

/* Word `word` of a block's pillars. With several lanes all words of a block lie together, lane by
 * lane, those of other blocks' lanes unused; with one lane the words of a row of pillars do. */
PF_INLINE global Word* word_at(Calibration calibration, uint word, uint row, Block block) {
  global uint* const words = (global uint*)PF_PLANE_OF(calibration, uint, (size_t)PF_MEMORY_PLANE);
#ifdef PF_SCALAR
  return words + ((size_t)row * PF_MEMORY_WORDS + word) * block.blocks + block.at;
#else
  const size_t number = (size_t)row * block.blocks + block.at;
  return (global Word*)(words + (number * PF_MEMORY_WORDS + word) * PF_LANES);
#endif
}

/* Prefetches the states of the block one pillar row below. */
PF_INLINE void prefetch_states(Calibration calibration, Block block) {
  PF_PREFETCH_SPAN(word_at(calibration, 0, block.top.row / 2 + 1, block), PF_MEMORY_WORDS, 2);
}

/* Removes hysteresis and creep from a block's sensels, and updates their states. */
PF_INLINE Pillar recall_block(Pillar pillar, Calibration calibration, Block block) {
  const Stages stages = calibration.stages;
  const Real threshold = PF_VALUE(Real, threshold);
  if (!any_lane(is_touched_pillar(pillar, threshold))) return pillar;
  const MemoryModel model = memory_model(stages);
  const uint row = block.top.row / 2;
  Memory memory;
  memory.last = *word_at(calibration, 0, row, block);
  PF_UNROLL
  for (int i = 0; i < PF_MAX_STATES; ++i) {
    const int number = number_of_state(i, model);
    const bool has = number >= 0;
    memory.pair[0][i] =
        has ? *word_at(calibration, 1 + 2 * number, row, block) : PF_CONSTANT(Word, 0);
    memory.pair[1][i] =
        has ? *word_at(calibration, 2 + 2 * number, row, block) : PF_CONSTANT(Word, 0);
  }
  const Recalled result =
      recall(pillar, memory, model, threshold, PF_CONSTANT(Word, calibration.frame));
  *word_at(calibration, 0, row, block) = result.memory.last;
  PF_UNROLL
  for (int i = 0; i < PF_MAX_STATES; ++i) {
    const int number = number_of_state(i, model);
    if (number < 0) continue;
    *word_at(calibration, 1 + 2 * number, row, block) = result.memory.pair[0][i];
    *word_at(calibration, 2 + 2 * number, row, block) = result.memory.pair[1][i];
  }
  return result.pillar;
}

#endif
