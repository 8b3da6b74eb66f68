/* Row and column crosstalk of a scanned array (docs/derivations/sensor_effects.md, E5). */

/* Largest gain of a row; beyond it the readout is saturated. */
#define PF_WIRE_LARGEST_GAIN PF_REAL(1.4)

/* What the wires do to a sensel. */
typedef struct {
  Real row;    /* a: voltage that the driven row should have over what it has */
  Real idle;   /* 1 / (1 + R_idle * conductance of the row): part of the row's conductance that
                  loads the columns while other rows are driven */
  Real column; /* conductance that loads the column, counts */
} Wires;

/* Factor by which the load of its column lowers a reading. */
PF_INLINE Real column_load(Real reading, Wires at, Real column_per_count) {
  const Real one = PF_REAL(1.0);
  const Real rough = reading * at.row * (one + column_per_count * at.column);
  return one + column_per_count * (at.column + rough * (one - at.idle));
}

/* Conductance of a sensel, counts, from its reading. */
PF_INLINE Real conductance(Real reading, Wires at, Real column_per_count) {
  return reading * at.row * column_load(reading, at, column_per_count);
}

/* Removes the crosstalk from a raw reading; where the readout is saturated the sensel is missing.
 */
PF_INLINE Sensel remove_crosstalk(Sensel sensel, Wires at, Real column_per_count) {
  sensel.missing = sensel.missing || !(at.row <= PF_WIRE_LARGEST_GAIN);
  sensel.reading = conductance(sensel.reading, at, column_per_count);
  return sensel;
}
