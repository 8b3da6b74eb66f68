/* A contact laid out for the field estimator: the box about its pillars, and what is known of each
 * (docs/derivations/field.md, section 2). Compiled as OpenCL C and as C++. */

/* A contact's box in the frame, and its share of the scratch memory. */
typedef struct {
  uint row; /* of the box's first pillar */
  uint col;
  uint rows;
  uint cols;
  uint first_cell; /* of (rows + 2) (cols + 2): a pillar's width is added all round */
  uint first_line; /* of rows records of sums */
  uint first_run;  /* of the contact, among the frame's runs */
  uint runs;
} Tile;

/* Loaded pillars of one row, side by side: ContactRun of host/include/pillarfield/contact_map.h. */
typedef struct {
  uint row;
  uint first;
  uint end;
  uint contact;
} Run;

/* What stands on a cell. */
#define PF_CELL_OUTSIDE 0   /* nothing of this contact */
#define PF_CELL_BEYOND 1    /* no skin: nothing is known */
#define PF_CELL_LOADED 2    /* loaded, and none of those that follow */
#define PF_CELL_RESOLVED 3  /* a force that its own readings determine */
#define PF_CELL_AMBIGUOUS 4 /* a segment of forces */

/* Scratch planes of all tiles. */
typedef struct {
  PF_GLOBAL uchar* kind;
  PF_GLOBAL float* top;      /* N: the normal force where resolved, its upper end where ambiguous */
  PF_GLOBAL float* fixed;    /* Segment::fixed, N */
  PF_GLOBAL float* moving;   /* Segment::moving, N */
  PF_GLOBAL float* weight;   /* of a pillar in the fit */
  PF_GLOBAL float* residual; /* of the pressure's power from its trend */
  PF_GLOBAL float* shaped;   /* normal force by the pressure's shape, N */
} Cells;

/* The planes of the frame that are read and written. Those from magnitude on are null where the
 * plan does not ask for them. */
typedef struct {
  PF_GLOBAL float* shear_x;
  PF_GLOBAL float* shear_y;
  PF_GLOBAL float* normal;
  PF_GLOBAL uchar* status;
  PF_GLOBAL float* magnitude;
  PF_GLOBAL float* theta;
  PF_GLOBAL float* phi;
  PF_GLOBAL float* deviation_x;
  PF_GLOBAL float* deviation_y;
  PF_GLOBAL float* deviation_normal;
  PF_GLOBAL float* theta_low;
  PF_GLOBAL float* theta_high;
  PF_GLOBAL float* phi_low;
  PF_GLOBAL float* phi_high;
  PF_GLOBAL float* magnitude_low;
  PF_GLOBAL float* magnitude_high;
  uint rows;
  uint cols;
} Field;

/* What was known of pillars when a frame had told it; for scenes whose frames are close in time.
 * The planes are null elsewhere. */
typedef struct {
  PF_GLOBAL float* normal;    /* N */
  PF_GLOBAL float* deviation; /* N */
  PF_GLOBAL uint* frame;      /* in which that was */
  uint now;                   /* the frame at hand, from 1 */
} Past;

/* The work-items that share a contact, and which of them this one is. */
typedef struct {
  uint first;
  uint step;
} Share;

/* Evidence is taken from so many rows of a box at most: every row of a small one. */
#define PF_MOST_SAMPLED_ROWS 32u

static inline uint sampling_of(Tile tile) {
  return (tile.rows + PF_MOST_SAMPLED_ROWS - 1) / PF_MOST_SAMPLED_ROWS;
}

static inline uint cell_at(Tile tile, uint row, uint col) {
  return tile.first_cell + (row + 1) * (tile.cols + 2) + col + 1;
}

static inline Force force_of_field(Field field, uint index) {
  Force force;
  force.shear_x = field.shear_x[index];
  force.shear_y = field.shear_y[index];
  force.normal = field.normal[index];
  return force;
}

static inline Segment segment_of_cell(Cells cells, uint cell) {
  Segment segment;
  segment.fixed = cells.fixed[cell];
  segment.moving = cells.moving[cell];
  segment.high = cells.top[cell];
  return segment;
}

static inline uint usable_sensels(uchar status) {
  return (status & 1u) + ((status >> 1) & 1u) + ((status >> 2) & 1u) + ((status >> 3) & 1u);
}

/* Whether the pillar's force is one of a segment that neighbours may settle: two adjacent sensels
 * usable, the others lifted. */
static inline bool is_open(uchar status) {
  const uchar spoilt = PF_STATUS_SATURATED | PF_STATUS_INCONSISTENT;
  return (status & PF_STATUS_AMBIGUOUS) != 0 && (status & spoilt) == 0 &&
         usable_sensels(status) == 2;
}

/* Whether its own readings determine its force. */
static inline bool is_determined(uchar status) {
  return usable_sensels(status) >= 3 && (status & PF_STATUS_SATURATED) == 0;
}

/* Marks the cells of the box and around it as empty, or as beyond the skin. */
static inline void clear_tile(Tile tile, Cells cells, Field field, Share share) {
  for (uint line = share.first; line < tile.rows + 2; line += share.step) {
    const bool row_is_skin = tile.row + line >= 1 && tile.row + line <= field.rows;
    for (uint at = 0; at < tile.cols + 2; ++at) {
      const bool is_skin = row_is_skin && tile.col + at >= 1 && tile.col + at <= field.cols;
      const uint cell = tile.first_cell + line * (tile.cols + 2) + at;
      cells.kind[cell] = is_skin ? PF_CELL_OUTSIDE : PF_CELL_BEYOND;
      cells.top[cell] = 0.0f;
    }
  }
}

static inline void load_cell(Cells cells, uint cell, Field field, uint index, float segment_point) {
  const uchar status = field.status[index];
  const Force force = force_of_field(field, index);
  if (is_open(status) && force.normal > 0.0f) {
    const Segment segment = segment_of(force, moves_vertically((Bits)status), segment_point);
    cells.kind[cell] = PF_CELL_AMBIGUOUS;
    cells.top[cell] = segment.high;
    cells.fixed[cell] = segment.fixed;
    cells.moving[cell] = segment.moving;
    return;
  }
  const bool determined = is_determined(status) && force.normal > 0.0f;
  cells.kind[cell] = determined ? PF_CELL_RESOLVED : PF_CELL_LOADED;
  cells.top[cell] = determined ? force.normal : 0.0f;
}

/* Fills the contact's own cells. */
static inline void load_tile(Tile tile, Cells cells, Field field, PF_GLOBAL const Run* runs,
                             float segment_point, Share share) {
  for (uint at = share.first; at < tile.runs; at += share.step) {
    const Run run = runs[tile.first_run + at];
    for (uint col = run.first; col < run.end; ++col) {
      load_cell(cells, cell_at(tile, run.row - tile.row, col - tile.col), field,
                run.row * field.cols + col, segment_point);
    }
  }
}
