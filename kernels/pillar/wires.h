/* Row and column crosstalk of a scanned array (docs/derivations/sensor_effects.md, E5). */

/* Largest gain of a row, of the type that `constant` gives; beyond it the readout is saturated. */
#define PF_WIRE_LARGEST_GAIN(constant) constant(1.4)

/* Effect of the wires on a sensel. */
typedef struct {
  Real row;    /* a: ideal over actual voltage of the driven row */
  Real own;    /* k a: what the driven row adds to the loss of its column, per count */
  Real column; /* l: correction factor of the column, without the driven row */
} Wires;

/* Conductance over reading. */
PF_INLINE Real wire_gain(Real reading, Wires at) {
  return at.row * at.column * (PF_REAL(1.0) + at.own * reading);
}

/* Removes the crosstalk from a raw reading; where the readout is saturated the sensel is missing.
 */
PF_INLINE Sensel remove_crosstalk(Sensel sensel, Wires at) {
  sensel.missing = sensel.missing || !(at.row <= PF_WIRE_LARGEST_GAIN(PF_REAL));
  sensel.reading = sensel.reading * wire_gain(sensel.reading, at);
  return sensel;
}
