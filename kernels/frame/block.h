/* What a work-item of solve_frame.cl reads and writes. */

#ifdef PF_LEAK
/* Rows of sensels around a pillar row: neighbours.h. */
typedef struct {
  global float* values;
  size_t stride;
} Ring;
#endif

typedef struct {
  global const PF_SENSEL* raw;
  size_t row_stride;
  Calibration calibration;
  uint rows; /* pillars */
  uint cols;
#ifdef PF_LEAK
  Ring ring;
#endif
} Input;

typedef struct {
  global uchar* forces; /* planes of forces: `planes`, or the scratch memory */
  global uchar* planes;
  size_t plane_bytes;
  global uchar* status;
  global uchar* idle; /* flag of each block: its stored results are those of an idle block */
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
