/* Sweeps over a tile's sensels, which find how its wires act on readings
 * (docs/derivations/sensor_effects.md, E5). For the device and, as C++, for the host. Rows of
 * numbers are padded with zeros to a multiple of PF_WIRE_PARTS. */

#define PF_WIRE_SWEEPS 2
#define PF_WIRE_PARTS 16           /* partial sums, added in a fixed order */
#define PF_WIRE_LEAST_SHARE 0.125f /* of the voltage; a wire keeps at least this */

/* Resistances times the conductance of one count. */
typedef struct {
  float row;
  float column;
  float idle;
} WireModel;

/* Wires of rows of sensels, one row a lane. */
typedef struct {
  Real row;    /* a, as in Wires */
  Real driven; /* k = C (1 - lambda), with the factor lambda of idle rows */
} RowWires;

/* PF_WIRE_PARTS sensels at once: vectors of the device, or one by one. */
#if defined(PF_SCALAR) || (defined(__cplusplus) && !defined(PF_LANES))
#define PF_WIRE_SCALAR
#define PF_WIRE_LANES 1
#else
#define PF_WIRE_LANES PF_LANES
#endif
#ifdef PF_WIRE_SCALAR
#define PF_LOAD_WIRES(place) (*(place))
#define PF_STORE_WIRES(value, place) *(place) = (value)
#elif defined(__cplusplus)
#define PF_LOAD_WIRES(place) load_whole<Real>(place)
#define PF_STORE_WIRES(value, place) store_whole<Real>(value, place)
#else
#define PF_LOAD_WIRES(place) (((const WireLanes*)(place))->lanes)
#define PF_STORE_WIRES(value, place) ((WireLanes*)(place))->lanes = (value)
/* As in load_store.h. */
typedef struct __attribute__((packed, may_alias)) {
  Real lanes;
} WireLanes;
#endif
#define PF_WIRE_GROUPS (PF_WIRE_PARTS / PF_WIRE_LANES)

/* Sum of lanes, by pairs. */
#ifdef PF_WIRE_SCALAR
PF_INLINE float sum_of_lanes(Real lanes) { return lanes; }
#elif defined(__cplusplus)
PF_INLINE float sum_of_lanes(Real lanes) {
  for (int half = PF_LANES / 2; half > 0; half /= 2) {
    for (int lane = 0; lane < half; ++lane) lanes[lane] = lanes[lane] + lanes[lane + half];
  }
  return lanes[0];
}
#else
PF_INLINE float sum_of_2(float2 lanes) { return lanes.x + lanes.y; }
PF_INLINE float sum_of_4(float4 lanes) { return sum_of_2(lanes.lo + lanes.hi); }
PF_INLINE float sum_of_8(float8 lanes) { return sum_of_4(lanes.lo + lanes.hi); }
PF_INLINE float sum_of_16(float16 lanes) { return sum_of_8(lanes.lo + lanes.hi); }
PF_INLINE float sum_of_lanes(Real lanes) { return PF_JOIN(sum_of_, PF_LANES)(lanes); }
#endif

/* Sum of the parts in all lanes, by pairs; overwrites them. */
PF_INLINE float sum_of_parts(Real* parts) {
  for (int lower = PF_WIRE_GROUPS / 2; lower > 0; lower /= 2) {
    for (int i = 0; i < lower; ++i) parts[i] = parts[i] + parts[i + lower];
  }
  return sum_of_lanes(parts[0]);
}

/* 1 / (1 - loss), bounded. */
#define PF_DEFINE_GAIN(name, type)                                    \
  PF_INLINE type name(type loss) {                                    \
    const type least = PF_CONSTANT(type, PF_WIRE_LEAST_SHARE);        \
    const type share = PF_CONSTANT(type, 1.0f) - loss;                \
    return PF_CONSTANT(type, 1.0f) / (share > least ? share : least); \
  }
PF_DEFINE_GAIN(gain_of_loss, float)
PF_DEFINE_GAIN(gains_of_losses, Real)

/* Sums of m l and m^2 l over a row. */
typedef struct {
  float load;
  float square;
} RowSums;

/* The sums of a row with these readings, counts, under columns with the gains `columns`. */
PF_INLINE RowSums sums_of_row(const float* readings, const float* columns, int cols) {
  Real loads[PF_WIRE_GROUPS];
  Real squares[PF_WIRE_GROUPS];
  for (int i = 0; i < PF_WIRE_GROUPS; ++i) loads[i] = squares[i] = PF_REAL(0.0);
  for (int at = 0; at < cols; at += PF_WIRE_PARTS) {
    for (int i = 0; i < PF_WIRE_GROUPS; ++i) {
      const int place = at + i * PF_WIRE_LANES;
      const Real reading = PF_LOAD_WIRES(readings + place);
      const Real load = reading * PF_LOAD_WIRES(columns + place);
      loads[i] = loads[i] + load;
      squares[i] = squares[i] + reading * load;
    }
  }
  const RowSums sums = {sum_of_parts(loads), sum_of_parts(squares)};
  return sums;
}

/* The wires of rows with these sums. */
PF_INLINE RowWires wires_of_rows(Real load, Real square, RowWires before, WireModel model) {
  const Real one = PF_REAL(1.0);
  const Real column = PF_CONSTANT(Real, model.column);
  square = before.row * square;
  RowWires after;
  after.row =
      gains_of_losses(PF_CONSTANT(Real, model.row) * (load + (before.driven - column) * square));
  const Real loss = PF_CONSTANT(Real, model.idle) * after.row * (load + before.driven * square);
  after.driven = column * (loss / (one + loss));
  return after;
}

/* Loss of columns in an idle row with these readings, divided by their gain. */
PF_INLINE Real losses_in_row(Real reading, float row, float driven, WireModel model) {
  const Real first = PF_CONSTANT(Real, (model.column - driven) * row);
  const Real second = PF_CONSTANT(Real, driven * row);
  return first * reading * (PF_REAL(1.0) + second * reading);
}

/* Adds the losses of columns in an idle row to `losses`. */
PF_INLINE void add_row(const float* readings, float* losses, int cols, float row, float driven,
                       WireModel model) {
  for (int at = 0; at < cols; at += PF_WIRE_LANES) {
    const Real loss = losses_in_row(PF_LOAD_WIRES(readings + at), row, driven, model);
    PF_STORE_WIRES(PF_LOAD_WIRES(losses + at) + loss, losses + at);
  }
}

/* The gains of columns with these losses, which become zero. */
PF_INLINE void find_columns(float* losses, float* columns, int cols) {
  for (int at = 0; at < cols; at += PF_WIRE_LANES) {
    PF_STORE_WIRES(gains_of_losses(PF_LOAD_WIRES(losses + at)), columns + at);
    PF_STORE_WIRES(PF_REAL(0.0), losses + at);
  }
}
