/* The entry points of the field estimator, which go over what the direct solve left open. A program
 * of its own, with PF_LANES 1. */

static inline Field field_of(global float* shear_x, global float* shear_y, global float* normal,
                             global uchar* status, uint rows, uint cols) {
  const Field field = {shear_x, shear_y, normal, status, rows, cols};
  return field;
}

static inline FieldSettings settings_of(float noise, float quiet, float friction, uint slips,
                                        uint shape, uint slip, uint sweeps) {
  const FieldSettings settings = {noise, quiet, friction, slips, shape, slip, sweeps};
  return settings;
}

/* A work-group resolves a contact; its work-items share the lines of the box. */
kernel void resolve_contacts(global float* shear_x, global float* shear_y, global float* normal,
                             global uchar* status, uint rows, uint cols, float noise, float quiet,
                             float friction, uint slips, uint shape, uint slip, uint sweeps,
                             global const Tile* tiles, global const Run* runs,
                             global Verdict* verdicts, global uchar* kind, global float* planes,
                             ulong cells, global double* lines, global double* shared,
                             global uint* counts) {
  const uint contact = (uint)get_group_id(0);
  const Cells scratch_cells = {kind,
                               planes,
                               planes + cells,
                               planes + 2 * cells,
                               planes + 3 * cells,
                               planes + 4 * cells,
                               planes + 5 * cells,
                               planes + 6 * cells};
  const Scratch scratch = {scratch_cells, lines, shared + contact * PF_SHARED_SUMS,
                           counts + contact * PF_RATIO_COUNTS};
  const Share share = {(uint)get_local_id(0), (uint)get_local_size(0)};
  const Verdict verdict = resolve_contact(
      tiles[contact], scratch, field_of(shear_x, shear_y, normal, status, rows, cols), runs,
      settings_of(noise, quiet, friction, slips, shape, slip, sweeps), share);
  if (share.first == 0) verdicts[contact] = verdict;
}

/* A work-item resolves a pillar whose contact tells nothing. */
kernel void resolve_pillars(global float* shear_x, global float* shear_y, global float* normal,
                            global uchar* status, uint rows, uint cols, float noise, float quiet,
                            float friction, uint slips, uint shape, uint slip, uint sweeps,
                            global const uint* pillars, uint count) {
  const Field field = field_of(shear_x, shear_y, normal, status, rows, cols);
  const FieldSettings settings = settings_of(noise, quiet, friction, slips, shape, slip, sweeps);
  for (uint at = (uint)get_global_id(0); at < count; at += (uint)get_global_size(0)) {
    resolve_alone(field, pillars[at], settings);
  }
}
