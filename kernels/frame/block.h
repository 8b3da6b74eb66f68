/* Inputs and outputs of a work-item of solve_frame.cl. */

#if defined(PF_LEAK) && !defined(PF_SCALAR)
#define PF_RING
/* The pillar rows around one: neighbours.h. */
typedef struct {
  global float* values; /* [PF_RING_ROWS, sensel row, side, stride] */
  global uchar* idle;   /* [PF_RING_ROWS, blocks]: flags of the idle ones */
  size_t stride;
  uint blocks;
  uint written; /* a bit for each row that is not zero */
} Ring;

#define PF_RING_ROWS 3

/* Place of a pillar row in the ring. */
PF_INLINE uint place_in_ring(uint row) { return (row + 1) % PF_RING_ROWS; }

PF_INLINE global uchar* idle_in_ring(Ring ring, uint row) {
  return ring.idle + place_in_ring(row) * ring.blocks;
}
#endif

typedef struct {
  global const PF_SENSEL* raw;
  size_t row_stride;
  Calibration calibration;
  uint rows; /* pillars */
  uint cols;
#ifdef PF_RING
  Ring ring;
#endif
} Input;

typedef struct {
  global uchar* forces; /* planes of forces: `planes`, or the scratch memory */
  global uchar* planes;
  size_t plane_bytes;
  global uchar* status;
  global uchar* idle; /* flag of each block: its stored results are those of an idle block */
#ifdef PF_SENSELS
  global uchar* touched; /* status bits of the sensels of each 2 x 2, with PF_BASELINE */
  uint rows;             /* sensels */
  uint cols;
#endif
} Output;

/* A block of PF_LANES pillars: `raw` points to its upper left sensel, whose place is `top`;
 * `bottom` is that of the one below, `index` the first pillar's index in the results. Results of
 * `lanes` are written. */
typedef struct {
  global const PF_SENSEL* raw;
  Place top;
  Place bottom;
  size_t index;
  Lanes lanes;
#ifdef PF_MEMORY
  uint at;     /* number of the block in its row */
  uint blocks; /* blocks_of_row() */
#endif
} Block;
