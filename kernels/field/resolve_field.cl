/* The entry points of the field estimator, which go over what the direct solve left open. A program
 * of its own, with PF_LANES 1. Both read and write the planes [rows, cols] of a result; those from
 * magnitude on may be null. */
#define PF_FIELD_PARAMETERS                                                                       \
  global float *shear_x, global float *shear_y, global float *normal, global uchar *status,       \
      global float *magnitude, global float *theta, global float *phi, global float *deviation_x, \
      global float *deviation_y, global float *deviation_normal, global float *theta_low,         \
      global float *theta_high, global float *phi_low, global float *phi_high,                    \
      global float *magnitude_low, global float *magnitude_high, uint rows, uint cols,            \
      float noise, float quiet, float friction, uint slips, uint shape, uint slip, uint sweeps,   \
      float segment_point, global float *past_normal, global float *past_deviation,               \
      global uint *past_frame, uint now
#define PF_FIELD                                                                                   \
  {                                                                                                \
    shear_x, shear_y, normal, status, magnitude, theta, phi, deviation_x, deviation_y,             \
        deviation_normal, theta_low, theta_high, phi_low, phi_high, magnitude_low, magnitude_high, \
        rows, cols                                                                                 \
  }
#define PF_PAST \
  { past_normal, past_deviation, past_frame, now }
#define PF_FIELD_SETTINGS \
  { noise, quiet, friction, slips, shape, slip, sweeps, segment_point }

/* A work-group resolves a contact; its work-items share the lines of the box.
 *
 * tiles      one for each group
 * runs       of all contacts of the frame
 * verdicts   one for each group
 * kind ..    scratch memory: `cells` of each plane, PF_LINE_SUMS of each line, and for each group
 *            PF_SHARED_SUMS and PF_RATIO_COUNTS */
kernel void resolve_contacts(PF_FIELD_PARAMETERS, global const Tile* tiles, global const Run* runs,
                             global Verdict* verdicts, global uchar* kind, global float* planes,
                             ulong cells, global double* lines, global double* shared,
                             global uint* counts) {
  const uint contact = (uint)get_group_id(0);
  const Field field = PF_FIELD;
  const FieldSettings settings = PF_FIELD_SETTINGS;
  const Past past = PF_PAST;
  const Cells all = {kind,
                     planes,
                     planes + cells,
                     planes + 2 * cells,
                     planes + 3 * cells,
                     planes + 4 * cells,
                     planes + 5 * cells};
  const Scratch scratch = {all, lines, shared + contact * PF_SHARED_SUMS,
                           counts + contact * PF_RATIO_COUNTS};
  const Share share = {(uint)get_local_id(0), (uint)get_local_size(0)};
  const Verdict verdict =
      resolve_contact(tiles[contact], scratch, field, past, runs, settings, share);
  if (share.first == 0) verdicts[contact] = verdict;
}

/* A work-item resolves every get_global_size(0)-th of the `count` pillars whose contacts tell
 * nothing. */
kernel void resolve_pillars(PF_FIELD_PARAMETERS, global const uint* pillars, uint count) {
  const Field field = PF_FIELD;
  const FieldSettings settings = PF_FIELD_SETTINGS;
  const Past past = PF_PAST;
  for (uint at = (uint)get_global_id(0); at < count; at += (uint)get_global_size(0)) {
    resolve_alone(field, past, pillars[at], settings);
  }
}

/* A work-item keeps every get_global_size(0)-th of the `count` runs for the frame that follows. */
kernel void keep_runs(PF_FIELD_PARAMETERS, global const Run* runs, uint count) {
  const Field field = PF_FIELD;
  const Past past = PF_PAST;
  for (uint at = (uint)get_global_id(0); at < count; at += (uint)get_global_size(0)) {
    keep_run(field, past, runs[at], noise);
  }
}
