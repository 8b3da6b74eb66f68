/* Skips idle tiles and blocks behind wires, which make readings too small by a gain that differs
 * from tile to tile. A tile whose readings stay below their activation thresholds under the largest
 * gain that its readings allow is idle: its gains are not needed, and its blocks are skipped
 * unread. Elsewhere a bound on the gain of each row tells which blocks are idle. Stages PF_WIRES
 * and PF_SKIP_IDLE. */
#if defined(PF_WIRES) && defined(PF_SKIP_IDLE)

/* Bound of an idle tile; of a row whose readout is saturated: no reading is idle behind it. */
#define PF_IDLE_TILE 0.0f
#define PF_SATURATED_ROW (float)(INFINITY)
#define PF_FLOAT(x) x##f
#define PF_ROWS_AHEAD 64 /* that are prefetched */
/* The largest load of an idle sensel: with PF_WIRES_AFTER_TARE the wires act on what it reads above
 * its tare, which the activation threshold bounds (idle_load). */
#define PF_LARGEST_LOAD(range) (PF_AFTER_TARE ? PF_NUMBER(idle_load) : (range).largest)
#define PF_LOAD_OF(counts) (PF_AFTER_TARE ? PF_VALUE(Real, idle_load) : fabs(counts))
/* Factor above 1 that covers the rounding of a bound. */
#define PF_BOUND_RESERVE 1.00001f

/* Pillars do not share tiles, and no other stage needs the gains of idle sensels. */
#ifdef PF_BASELINE
#define PF_READS_ALL_WIRES PF_NAMED(follow_baseline)
#else
#define PF_READS_ALL_WIRES 0
#endif
#define PF_SKIPS_IDLE_TILES (PF_TILE_ROWS % 2 == 0 && PF_TILE_COLS % 2 == 0 && !PF_READS_ALL_WIRES)

/* Greatest absolute reading of a tile, and least distance of a reading from its threshold, both in
 * counts; negative where a reading is out of range. */
typedef struct {
  float largest;
  float distance;
} TileRange;

PF_INLINE TileRange wider_range(TileRange a, TileRange b) {
  const TileRange range = {max(a.largest, b.largest), min(a.distance, b.distance)};
  return range;
}

/* Readings in their own type, which is narrower, if all are valid numbers. */
#ifdef PF_SCALAR
#define PF_SENSELS_AT(place) (*(place))
#define PF_REALS_OF(readings) (PF_CONSTANT(Real, readings))
#else
#define PF_SENSELS_AT(place) PF_LOAD_WHOLE(PF_SENSEL, place)
#define PF_REALS_OF(readings) PF_TO_REAL(readings)
#endif
#ifdef PF_RANGE
typedef Real SenselLanes;
#define PF_READINGS_AT(place) PF_REALS_OF(PF_SENSELS_AT(place))
#else
#ifdef PF_SCALAR
typedef PF_SENSEL SenselLanes;
#else
typedef PF_LANE_TYPE(PF_SENSEL) SenselLanes;
#endif
#define PF_READINGS_AT(place) PF_SENSELS_AT(place)
#endif
#ifdef PF_ACTIVATION_PLANE
#define PF_THRESHOLDS_AT(calibration, offset) \
  PF_READINGS_AT(activation_thresholds(calibration) + (offset))
#else
#define PF_THRESHOLDS_AT(calibration, offset) \
  (PF_CONSTANT(SenselLanes, (PF_SENSEL)(PF_NUMBER(activation))))
#endif

/* The same by lanes. */
typedef struct {
  SenselLanes largest;
  SenselLanes distance;
} LaneRange;

PF_INLINE LaneRange range_with(LaneRange range, SenselLanes reading, SenselLanes threshold,
                               Stages stages) {
#ifdef PF_RANGE
  const Real size = fabs(reading);
  const Real distance =
      size <= PF_VALUE(Real, largest) ? threshold - reading : PF_CONSTANT(Real, -1.0f);
  /* An infinite reading is active; as a bound it would make others idle. */
  range.largest = size <= PF_VALUE(Real, largest) && size > range.largest ? size : range.largest;
#else
  const SenselLanes distance = max(threshold, reading) - reading; /* No less than zero. */
  range.largest = max(reading, range.largest);
#endif
  range.distance = min(distance, range.distance);
  return range;
}

PF_INLINE TileRange range_of_lanes(LaneRange range) {
#ifdef PF_SCALAR
  const TileRange result = {(float)range.largest, (float)range.distance};
#else
  float largest[PF_LANES];
  float distances[PF_LANES];
  PF_VSTORE(PF_REALS_OF(range.largest), 0, largest);
  PF_VSTORE(PF_REALS_OF(range.distance), 0, distances);
  TileRange result = {largest[0], distances[0]};
  for (uint i = 1; i < PF_LANES; ++i) {
    const TileRange lane = {largest[i], distances[i]};
    result = wider_range(result, lane);
  }
#endif
  return result;
}

/* Prefetches a row of a tile with the thresholds; rows are too short for hardware prefetching. */
PF_INLINE void prefetch_tile_row(global const PF_SENSEL* raw, Calibration calibration,
                                 Layout layout, Tile tile, uint row) {
  PF_PREFETCH_SPAN(raw + row * layout.row_stride + tile.col, tile.cols + 63 / sizeof(PF_SENSEL), 2);
#ifdef PF_ACTIVATION_PLANE
  PF_PREFETCH_SPAN(activation_thresholds(calibration) + row * calibration.stride + tile.col,
                   tile.cols + 63 / sizeof(PF_SENSEL), 2);
#endif
}

/* Whole tiles are read 64 bytes at a time: PoCL's compiler, unlike OpenCL C, has vectors of more
 * than 16 elements. */
#if PF_LANES == 16 && !defined(PF_RANGE) && defined(PF_ACTIVATION_PLANE) && \
    defined(POCL_DEVICE_ADDRESS_BITS) && !defined(__cplusplus)
#define PF_WIDE_LANES (64 / sizeof(PF_SENSEL))
typedef PF_SENSEL WideLanes __attribute__((ext_vector_type(64 / sizeof(PF_SENSEL))));
typedef struct __attribute__((packed)) {
  WideLanes value;
} PackedWideLanes;
#define PF_WIDE_AT(place) (((global const PackedWideLanes*)(place))->value)

PF_INLINE TileRange range_of_wide_lanes(const PF_SENSEL* largest, const PF_SENSEL* distance) {
  PF_SENSEL most = largest[0];
  PF_SENSEL least = distance[0];
  for (uint i = 1; i < PF_WIDE_LANES; ++i) {
    most = max(most, largest[i]);
    least = min(least, distance[i]);
  }
  const TileRange range = {(float)most, (float)least};
  return range;
}

/* The range of a tile of PF_TILE_COLS columns. The tile beside it, whose work-item mostly follows
 * on this thread, is prefetched. */
PF_INLINE TileRange range_of_whole_tile(global const PF_SENSEL* raw,
                                        global const PF_SENSEL* thresholds, size_t row_stride,
                                        size_t threshold_stride, uint rows, Stages stages) {
  WideLanes largest = (WideLanes)(0);
  WideLanes distance = (WideLanes)((PF_SENSEL)(PF_NUMBER(activation_never)));
  for (uint row = 0; row < rows; ++row) {
    for (uint col = 0; col < PF_TILE_COLS; col += PF_WIDE_LANES) {
      PF_PREFETCH_SPAN(raw + row * row_stride + col + PF_TILE_COLS, 1, 2);
      PF_PREFETCH_SPAN(thresholds + row * threshold_stride + col + PF_TILE_COLS, 1, 2);
      const WideLanes reading = PF_WIDE_AT(raw + row * row_stride + col);
      const WideLanes threshold = PF_WIDE_AT(thresholds + row * threshold_stride + col);
      const WideLanes below = (threshold > reading ? threshold : reading) - reading;
      largest = reading > largest ? reading : largest;
      distance = below < distance ? below : distance;
    }
  }
  PackedWideLanes sizes = {largest};
  PackedWideLanes distances = {distance};
  return range_of_wide_lanes((const PF_SENSEL*)&sizes, (const PF_SENSEL*)&distances);
}
#endif

PF_INLINE TileRange range_of_tile(global const PF_SENSEL* raw, Calibration calibration,
                                  Layout layout, Tile tile) {
  const Stages stages = calibration.stages;
  const TileRange unknown = {(float)(PF_NUMBER(activation_never)), -1.0f};
  if (tile.cols < PF_LANES) return unknown;
#ifdef PF_WIDE_LANES
  if (PF_TILE_COLS % PF_WIDE_LANES == 0 && tile.cols == PF_TILE_COLS) {
    return range_of_whole_tile(
        raw + tile.row * layout.row_stride + tile.col,
        activation_thresholds(calibration) + tile.row * calibration.stride + tile.col,
        layout.row_stride, calibration.stride, tile.rows, stages);
  }
#endif
  LaneRange range = {PF_CONSTANT(SenselLanes, 0),
                     PF_CONSTANT(SenselLanes, (PF_SENSEL)(PF_NUMBER(activation_never)))};
  for (uint row = tile.row; row < tile.row + min(tile.rows, (uint)PF_ROWS_AHEAD); ++row) {
    prefetch_tile_row(raw, calibration, layout, tile, row);
  }
  for (uint row = tile.row; row < tile.row + tile.rows; ++row) {
    if (row + PF_ROWS_AHEAD < tile.row + tile.rows) {
      prefetch_tile_row(raw, calibration, layout, tile, row + PF_ROWS_AHEAD);
    }
    global const PF_SENSEL* const readings = raw + row * layout.row_stride + tile.col;
    for (uint at = 0; at < tile.cols; at += PF_LANES) {
      const uint col = min(at, tile.cols - PF_LANES);
      range = range_with(range, PF_READINGS_AT(readings + col),
                         PF_THRESHOLDS_AT(calibration, row * calibration.stride + tile.col + col),
                         stages);
    }
  }
  return range_of_lanes(range);
}

#ifdef PF_SCALAR
/* The range of a tile by the work-items of a group. `ranges`: of PF_TILE_ITEMS parts. */
PF_INLINE TileRange range_in_group(global const PF_SENSEL* raw, Calibration calibration,
                                   Layout layout, Tile tile, local TileRange* ranges) {
  const Stages stages = calibration.stages;
  TileRange range = {0.0f, (float)(PF_NUMBER(activation_never))};
  for (uint row = PF_TILE_ITEM; row < tile.rows; row += PF_TILE_ITEMS) {
    const Tile part = {tile.row + row, tile.col, 1, tile.cols};
    range = wider_range(range, range_of_tile(raw, calibration, layout, part));
  }
  ranges[PF_TILE_ITEM] = range;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (uint i = 0; i < PF_TILE_ITEMS; ++i) range = wider_range(range, ranges[i]);
  return range;
}
#endif

/* A bound on the gains of all sensels of a tile, by the sweeps of find_wires with the largest
 * reading everywhere. */
PF_INLINE float largest_gain(float largest, Tile tile, Stages stages) {
  const float own = 1.0f + 2.0f * PF_NUMBER(column_per_count) * largest;
  float row = 1.0f;
  float column = 1.0f;
  for (uint sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    row = gain_of_loss(PF_NUMBER(row_per_count) * (float)tile.cols * largest * own * column);
    column = gain_of_loss(PF_NUMBER(column_per_count) * (float)tile.rows * largest * own * row);
  }
  return row * column * own * PF_BOUND_RESERVE;
}

/* True if a tile is idle; then writes gains of 1. */
PF_INLINE bool find_idle_tile(TileRange range, Tile tile, WireVectors wires, size_t first,
                              global float* columns, Stages stages) {
  if (!PF_SKIPS_IDLE_TILES) return false;
  const float largest = PF_LARGEST_LOAD(range);
  const float gain = largest_gain(largest, tile, stages);
  const bool idle = gain <= PF_WIRE_LARGEST_GAIN(PF_FLOAT) &&
                    largest * (gain - 1.0f) + PF_NUMBER(activation_step) <= range.distance;
  for (uint i = PF_TILE_ITEM; idle && i < tile.rows; i += PF_TILE_ITEMS) {
    wires.row[first + i] = 1.0f;
    wires.own[first + i] = 0.0f;
    wires.bound[first + i] = PF_IDLE_TILE;
  }
  for (uint i = PF_TILE_ITEM; idle && i < tile.cols; i += PF_TILE_ITEMS) columns[i] = 1.0f;
  return idle;
}

/* Bounds of a tile's rows: how far a gain of their sensels is from 1 at most, plus 1. */
PF_INLINE void bound_rows(TileRange range, Tile tile, WireVectors wires, size_t first,
                          global const float* columns, Stages stages) {
  float least = columns[0];
  float most = columns[0];
  for (uint col = 1; col < tile.cols; ++col) {
    least = min(least, columns[col]);
    most = max(most, columns[col]);
  }
  for (size_t at = first + PF_TILE_ITEM; at < first + tile.rows; at += PF_TILE_ITEMS) {
    const float row = wires.row[at];
    const float own = wires.own[at] * PF_LARGEST_LOAD(range);
    const float high = row * most * (1.0f + own) * PF_BOUND_RESERVE;
    const float low = 2.0f - row * least * (1.0f - own) / PF_BOUND_RESERVE;
    wires.bound[at] = row <= PF_WIRE_LARGEST_GAIN(PF_FLOAT) ? max(high, low) : PF_SATURATED_ROW;
  }
}

/* The largest bound of the sensels under PF_LANES pillars. */
PF_INLINE float bound_of(WireVectors wires, Place place) {
  float bound = PF_IDLE_TILE;
  for (uint tile = place.col / PF_TILE_COLS; tile * PF_TILE_COLS < place.col + 2 * PF_LANES;
       ++tile) {
    global const float* const of_rows = wires.bound + (size_t)tile * wires.rows + place.row;
    bound = max(bound, max(of_rows[0], of_rows[1]));
  }
  return bound;
}

PF_INLINE Mask stays_idle(SenselLanes reading, SenselLanes threshold, Real rise, Stages stages) {
  const Real counts = PF_REALS_OF(reading);
  const Mask idle = counts + PF_LOAD_OF(counts) * rise <=
                    PF_REALS_OF(threshold) - PF_VALUE(Real, activation_step);
#ifdef PF_RANGE
  return idle && fabs(counts) <= PF_VALUE(Real, largest);
#else
  return idle;
#endif
}

/* As is_idle(), behind wires with this bound_of(). */
PF_INLINE bool rows_are_idle(global const PF_SENSEL* raw, size_t row_stride,
                             Calibration calibration, Place place, float bound) {
  const Stages stages = calibration.stages;
  const Real rise = PF_CONSTANT(Real, bound - 1.0f);
  Mask idle = mask_of(PF_BITS(-1));
  for (uint row = 0; row < 2; ++row) {
    for (uint side = 0; side < 2; ++side) {
      idle =
          idle && stays_idle(PF_READINGS_AT(raw + row * row_stride + side * PF_LANES),
                             PF_THRESHOLDS_AT(calibration, (place.row + row) * calibration.stride +
                                                               place.col + side * PF_LANES),
                             rise, stages);
    }
  }
  return !any_lane(!idle);
}

#endif
