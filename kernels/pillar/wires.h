/* Row and column crosstalk of a scanned array (docs/derivations/sensor_effects.md, E5). */

/* Largest gain of a row, of the type that `constant` gives; beyond it the readout is saturated. */
#define PF_WIRE_LARGEST_GAIN(constant) constant(1.4)

/* What the wires do to a sensel. */
typedef struct {
  Real row;    /* a: voltage that the driven row should have over what it has */
  Real idle;   /* lambda = 1 / (1 + R_idle * conductance of the row): part of the row's conductance
                  that loads the columns while other rows are driven */
  Real column; /* l: what the column should read over what it reads, but for the driven row */
} Wires;

/* Conductance over reading. */
PF_INLINE Real wire_gain(Real reading, Wires at, Real column_per_count) {
  const Real one = PF_REAL(1.0);
  const Real own = column_per_count * (one - at.idle) * at.row;
  return at.row * at.column * (one + own * reading);
}

/* Removes the crosstalk from a raw reading; where the readout is saturated the sensel is missing.
 */
PF_INLINE Sensel remove_crosstalk(Sensel sensel, Wires at, Real column_per_count) {
  sensel.missing = sensel.missing || !(at.row <= PF_WIRE_LARGEST_GAIN(PF_REAL));
  sensel.reading = sensel.reading * wire_gain(sensel.reading, at, column_per_count);
  return sensel;
}
