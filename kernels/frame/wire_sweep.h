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

PF_INLINE float sum_of_parts(const float* parts) {
  float sum = 0.0f;
  for (int i = 0; i < PF_WIRE_PARTS; ++i) sum = sum + parts[i];
  return sum;
}

/* Finds the row's factors from its readings, counts, and from the loads of the columns before, and
 * adds the row to the loads `next`. `cols` is a multiple of PF_WIRE_PARTS; readings beyond the tile
 * are zero. */
PF_INLINE RowWires sweep_row(const float* readings, const float* columns, float* next, int cols,
                             RowWires before, WireModel model) {
  float all[PF_WIRE_PARTS] = {0.0f};
  float driven[PF_WIRE_PARTS] = {0.0f};
  for (int at = 0; at < cols; at += PF_WIRE_PARTS) {
    for (int i = 0; i < PF_WIRE_PARTS; ++i) {
      const float reading = readings[at + i] * before.row;
      const float rough = reading * (1.0f + model.column * columns[at + i]);
      const float load = 1.0f + model.column * (columns[at + i] + rough * (1.0f - before.idle));
      const float conductance = reading * load;
      all[i] = all[i] + conductance;
      driven[i] = driven[i] + conductance * (1.0f - model.column * conductance / load);
    }
  }
  RowWires after;
  after.row = 1.0f + model.row * sum_of_parts(driven);
  after.idle = 1.0f / (1.0f + model.idle * sum_of_parts(all));
  for (int at = 0; at < cols; ++at) {
    const float reading = readings[at] * before.row;
    const float rough = reading * (1.0f + model.column * columns[at]);
    const float load = 1.0f + model.column * (columns[at] + rough * (1.0f - before.idle));
    next[at] = next[at] + reading * load * after.idle;
  }
  return after;
}
