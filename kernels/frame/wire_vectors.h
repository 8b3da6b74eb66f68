/* Effect of the wires of each tile (WireCrosstalk), found by find_wires.cl: a and k a for each
 * row of sensels and tile across, the gain for each column and tile down. */
#ifdef PF_WIRES

/* The number of work-items that share a tile, as the host launches them, and which this one is. */
#ifdef PF_SCALAR
#define PF_TILE_ITEMS 64
#define PF_TILE_ITEM (uint) get_local_id(0)
#else
#define PF_TILE_ITEMS 1
#define PF_TILE_ITEM 0
#endif

typedef struct {
  global float* row;    /* [tiles across, sensel rows] */
  global float* own;    /* [tiles across, sensel rows] */
  global float* bound;  /* [tiles across, sensel rows]: idle_tiles.h */
  global float* column; /* [tiles down, sensel columns] */
  uint rows;            /* of sensels, an even number */
  uint cols;
} WireVectors;

PF_INLINE uint tiles_across(uint cols) { return (cols + PF_TILE_COLS - 1) / PF_TILE_COLS; }

PF_INLINE WireVectors wire_vectors(global float* memory, uint rows, uint cols) {
  const size_t per_row = (size_t)rows * tiles_across(cols);
  const WireVectors wires = {
      memory, memory + per_row, memory + 2 * per_row, memory + 3 * per_row, rows, cols};
  return wires;
}

/* The sensels of a tile: the first one, and how many there are. */
typedef struct {
  uint row;
  uint col;
  uint rows;
  uint cols;
} Tile;

typedef struct {
  Wires left;
  Wires right;
} WiresPair;

/* Wires of one row of sensels under PF_LANES pillars, from column `col` on. */
PF_INLINE WiresPair load_wires(WireVectors wires, uint row, uint col) {
  const RealPair columns =
      load_plane(wires.column + (size_t)(row / PF_TILE_ROWS) * wires.cols + col);
  const uint first = col / PF_TILE_COLS;
  const uint last = (col + 2 * PF_LANES - 1) / PF_TILE_COLS;
  WiresPair pair;
  if (first == last) {
    const size_t at = (size_t)first * wires.rows + row;
    pair.left.row = pair.right.row = PF_CONSTANT(Real, wires.row[at]);
    pair.left.own = pair.right.own = PF_CONSTANT(Real, wires.own[at]);
  } else if (PF_TILE_COLS >= 2 * PF_LANES) {
    /* Two tiles: lanes before and from the border on. */
    const size_t at = (size_t)first * wires.rows + row;
    const size_t next = at + wires.rows;
    const Real before = PF_CONSTANT(Real, (float)(last * PF_TILE_COLS - col)) -
                        PF_CONSTANT(Real, 2.0f) * PF_LANE_NUMBERS;
    const Mask left = before > PF_CONSTANT(Real, 0.0f);
    const Mask right = before > PF_CONSTANT(Real, 1.0f);
    pair.left.row = left ? PF_CONSTANT(Real, wires.row[at]) : PF_CONSTANT(Real, wires.row[next]);
    pair.right.row = right ? PF_CONSTANT(Real, wires.row[at]) : PF_CONSTANT(Real, wires.row[next]);
    pair.left.own = left ? PF_CONSTANT(Real, wires.own[at]) : PF_CONSTANT(Real, wires.own[next]);
    pair.right.own = right ? PF_CONSTANT(Real, wires.own[at]) : PF_CONSTANT(Real, wires.own[next]);
  } else {
    float rows[2 * PF_LANES];
    float owns[2 * PF_LANES];
    for (uint i = 0; i < 2 * PF_LANES; ++i) {
      const size_t at = (size_t)((col + i) / PF_TILE_COLS) * wires.rows + row;
      rows[i] = wires.row[at];
      owns[i] = wires.own[at];
    }
    const RealPair row_pair = load_private(rows);
    const RealPair own_pair = load_private(owns);
    pair.left.row = row_pair.left;
    pair.right.row = row_pair.right;
    pair.left.own = own_pair.left;
    pair.right.own = own_pair.right;
  }
  pair.left.column = columns.left;
  pair.right.column = columns.right;
  return pair;
}

#endif
