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
#ifdef __cplusplus
#define PF_WIRE_LANES 1
typedef float WireReal;
#define PF_LOAD_WIRES(place) (*(place))
#define PF_STORE_WIRES(value, place) *(place) = (value)
#define PF_WIRE_VALUE(x) (x)
#else
#define PF_WIRE_LANES PF_LANES
typedef Real WireReal;
#if PF_LANES == 1
#define PF_LOAD_WIRES(place) (*(place))
#define PF_STORE_WIRES(value, place) *(place) = (value)
#else
#define PF_LOAD_WIRES(place) PF_JOIN(vload, PF_LANES)(0, place)
#define PF_STORE_WIRES(value, place) PF_JOIN(vstore, PF_LANES)(value, 0, place)
#endif
#define PF_WIRE_VALUE(x) ((WireReal)(x))
#endif
#define PF_WIRE_GROUPS (PF_WIRE_PARTS / PF_WIRE_LANES)

PF_INLINE float sum_of_parts(const float* parts) {
  float sum = 0.0f;
  for (int i = 0; i < PF_WIRE_PARTS; ++i) sum = sum + parts[i];
  return sum;
}

/* Finds the row's factors from its readings, counts, and from the loads of the columns before, and
 * adds the row to the loads `next`. `cols` is a multiple of PF_WIRE_PARTS; readings beyond the tile
 * are zero. `conductances` is room for a row. */
PF_INLINE RowWires sweep_row(const float* readings, const float* columns, float* next,
                             float* conductances, int cols, RowWires before, WireModel model) {
  const WireReal one = PF_WIRE_VALUE(1.0f);
  const WireReal column = PF_WIRE_VALUE(model.column);
  WireReal all[PF_WIRE_GROUPS];
  WireReal driven[PF_WIRE_GROUPS];
  for (int i = 0; i < PF_WIRE_GROUPS; ++i) all[i] = driven[i] = PF_WIRE_VALUE(0.0f);
  for (int at = 0; at < cols; at += PF_WIRE_PARTS) {
    for (int i = 0; i < PF_WIRE_GROUPS; ++i) {
      const int place = at + i * PF_WIRE_LANES;
      const WireReal others = PF_LOAD_WIRES(columns + place);
      const WireReal reading = PF_LOAD_WIRES(readings + place) * PF_WIRE_VALUE(before.row);
      const WireReal rough = reading * (one + column * others);
      const WireReal load = one + column * (others + rough * (one - PF_WIRE_VALUE(before.idle)));
      const WireReal conductance = reading * load;
      all[i] = all[i] + conductance;
      driven[i] = driven[i] + conductance * (one - column * conductance / load);
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
    const WireReal more = PF_LOAD_WIRES(conductances + at) * PF_WIRE_VALUE(after.idle);
    PF_STORE_WIRES(PF_LOAD_WIRES(next + at) + more, next + at);
  }
  return after;
}
