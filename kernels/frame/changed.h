/* Skips what no change of the readings can alter: a row or block without its flag keeps the results
 * that an earlier frame left in this memory. The host sets the flags, neighbours of changed sensels
 * included (host/device/changed_blocks.h). Stage PF_CHANGED. */

/* Flags of the blocks of a pillar row; null if no block of the row changed. */
PF_INLINE global const uchar* changed_in_row(global const uchar* results, Layout layout, uint row) {
#ifdef PF_CHANGED
  const size_t stride = blocks_of_row((uint)layout.cols);
  global const uchar* const flags = results + layout.changed;
  return flags[layout.rows * stride + row] ? flags + row * stride : 0;
#else
  return results;
#endif
}

PF_INLINE bool is_changed(global const uchar* row, uint at) {
#ifdef PF_CHANGED
  return row[at] != 0;
#else
  return true;
#endif
}
