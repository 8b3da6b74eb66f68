/* One sweep over a row of a tile's sensels, which finds how its wires act on readings
 * (docs/derivations/sensor_effects.md, E5). For the device and, as C++, for the host. */

#define PF_WIRE_SWEEPS 3
#define PF_WIRE_PARTS 16 /* partial sums, added in a fixed order */

/* Resistances times the conductance of one count. */
typedef struct {
  float row;
  float column;
  float idle;
} WireModel;

typedef struct {
  float row; /* as in Wires */
  float idle;
} RowWires;

/* PF_WIRE_PARTS sensels at once: vectors of the device, or one by one. */
#if defined(__cplusplus)
#define PF_WIRE_LANES 1
#else
#define PF_WIRE_LANES PF_LANES
#endif
#if PF_WIRE_LANES == 1
#define PF_LOAD_WIRES(place) (*(place))
#define PF_STORE_WIRES(value, place) *(place) = (value)
#else
#define PF_LOAD_WIRES(place) PF_JOIN(vload, PF_LANES)(0, place)
#define PF_STORE_WIRES(value, place) PF_JOIN(vstore, PF_LANES)(value, 0, place)
#endif
#define PF_WIRE_GROUPS (PF_WIRE_PARTS / PF_WIRE_LANES)

/* Their sum, by pairs; overwrites them. */
PF_INLINE float sum_of_parts(float* parts) {
  for (int lower = PF_WIRE_PARTS / 2; lower > 0; lower /= 2) {
    for (int i = 0; i < lower; ++i) parts[i] = parts[i] + parts[i + lower];
  }
  return parts[0];
}

/* Finds the row's factors from its readings, counts, and from the loads of the columns before, and
 * adds the row to the loads `next`. `cols` is a multiple of PF_WIRE_PARTS; readings beyond the tile
 * are zero. `conductances` is room for a row. */
PF_INLINE RowWires sweep_row(const float* readings, const float* columns, float* next,
                             float* conductances, int cols, RowWires before, WireModel model) {
  const Real column = PF_CONSTANT(Real, model.column);
  Wires at_row;
  at_row.row = PF_CONSTANT(Real, before.row);
  at_row.idle = PF_CONSTANT(Real, before.idle);
  Real all[PF_WIRE_GROUPS];
  Real driven[PF_WIRE_GROUPS];
  for (int i = 0; i < PF_WIRE_GROUPS; ++i) all[i] = driven[i] = PF_REAL(0.0);
  for (int at = 0; at < cols; at += PF_WIRE_PARTS) {
    for (int i = 0; i < PF_WIRE_GROUPS; ++i) {
      const int place = at + i * PF_WIRE_LANES;
      const Real reading = PF_LOAD_WIRES(readings + place);
      at_row.column = PF_LOAD_WIRES(columns + place);
      const Real load = column_load(reading, at_row, column);
      const Real conductance = reading * at_row.row * load;
      all[i] = all[i] + conductance;
      driven[i] = driven[i] + conductance * (PF_REAL(1.0) - column * conductance / load);
      PF_STORE_WIRES(conductance, conductances + place);
    }
  }
  float all_parts[PF_WIRE_PARTS];
  float driven_parts[PF_WIRE_PARTS];
  for (int i = 0; i < PF_WIRE_GROUPS; ++i) {
    PF_STORE_WIRES(all[i], all_parts + i * PF_WIRE_LANES);
    PF_STORE_WIRES(driven[i], driven_parts + i * PF_WIRE_LANES);
  }
  RowWires after;
  after.row = 1.0f + model.row * sum_of_parts(driven_parts);
  after.idle = 1.0f / (1.0f + model.idle * sum_of_parts(all_parts));
  for (int at = 0; at < cols; at += PF_WIRE_LANES) {
    const Real more = PF_LOAD_WIRES(conductances + at) * PF_CONSTANT(Real, after.idle);
    PF_STORE_WIRES(PF_LOAD_WIRES(next + at) + more, next + at);
  }
  return after;
}
