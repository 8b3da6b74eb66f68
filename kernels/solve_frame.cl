/* Solves a frame: readings in, forces and status bytes out. Only indexing, loading, calling and
 * storing; the mathematics is in maths/.
 *
 * The host writes what a plan asks for as the first lines of the program:
 *
 *   PF_LANES                        pillars that a work-item solves at once: 1, 2, 4, 8, 16
 *   PF_SENSEL                       uchar, ushort or float
 *   PF_SHEAR_SCALE, PF_NORMAL_SCALE newtons per count (ForceScale)
 *   PF_THRESHOLD                    counts
 *   PF_LARGEST_READING              counts; stage: readings beyond, and NaN, are missing
 *   PF_FULL_SCALE                   counts; stage: saturation
 *   PF_TARE, PF_GAIN, PF_DEAD_ZONE, PF_MASK   stages: the calibration plane of that name is read
 *   PF_POWER_EXPONENT               stage: readings are straightened by a power law, with
 *   PF_POWER_REFERENCE, PF_POWER_LARGEST      counts
 *   PF_PAPER                        stage: the paper's estimator instead of the direct solve
 *   PF_DOUBT                        counts by which noise may shift what parity says
 *   PF_PARITY_TOLERANCE             counts; stage: the parity test
 *   PF_ANGLES                       stage: magnitude, theta and phi are written too
 *   PF_UNCERTAINTY                  noise of a raw reading, counts; stage: uncertainty is written
 *   PF_NOISE                        with PF_UNCERTAINTY: the noise is read from its plane instead
 *   PF_BASELINE                     stage: follow_baseline.cl
 *
 * A stage that is not named leaves no trace. Constants are exact (hexadecimal). */

static inline Force estimate(Pillar pillar, Diagonals diagonals, ParitySum sum) {
  const ForceScale scale = {(Real)(PF_SHEAR_SCALE), (Real)(PF_NORMAL_SCALE)};
#ifdef PF_PAPER
  return paper_force(pillar, diagonals, sum, scale);
#else
  return direct_force(diagonals, sum, scale);
#endif
}

static inline Bits status_of(Pillar pillar, ParitySum sum) {
  Bits status = direct_status(pillar, sum, (Real)(PF_DOUBT));
#ifdef PF_PARITY_TOLERANCE
  status = status |
           (fails_parity(pillar, sum, (Real)(PF_PARITY_TOLERANCE)) ? PF_BITS(PF_STATUS_INCONSISTENT)
                                                                   : PF_BITS(0));
#endif
  return status;
}

/* One work-item solves every get_global_size(0)-th block of PF_LANES pillars of its pillar row.
 *
 * raw           readings, `row_stride` apart from one row of sensels to the next
 * tare .. noise calibration planes [rows, plane_stride], or null
 * shear_x ..    results [get_global_size(1), pillar_cols]; those from magnitude on may be null */
kernel void solve_frame(global const PF_SENSEL* restrict raw, ulong row_stride, uint pillar_cols,
                        global const float* restrict tare, global const float* restrict gain,
                        global const float* restrict dead_zone, global const uchar* restrict mask,
                        global const float* restrict noise, ulong plane_stride,
                        global float* restrict shear_x, global float* restrict shear_y,
                        global float* restrict normal, global uchar* restrict status,
                        global float* restrict magnitude, global float* restrict theta,
                        global float* restrict phi, global float* restrict deviation_x,
                        global float* restrict deviation_y, global float* restrict deviation_normal,
                        global float* restrict theta_low, global float* restrict theta_high,
                        global float* restrict phi_low, global float* restrict phi_high,
                        global float* restrict magnitude_low,
                        global float* restrict magnitude_high) {
  const size_t row = get_global_id(1);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  const Planes planes = {tare, gain, dead_zone, mask, noise, plane_stride};

  for (uint col = (uint)get_global_id(0) * PF_LANES; col < pillar_cols; col += step) {
    const uint count = min(pillar_cols - col, (uint)PF_LANES);
    global const PF_SENSEL* const first = raw + 2 * row * row_stride + 2 * col;
    const size_t offset = 2 * row * planes.stride + 2 * col;
    const SenselPair top = read_sensels(first, planes, offset, count);
    const SenselPair bottom =
        read_sensels(first + row_stride, planes, offset + planes.stride, count);
    const Pillar pillar = {top.right, top.left, bottom.left, bottom.right};

    const Diagonals diagonals = pillar_diagonals(pillar);
    const ParitySum sum = parity_sum(diagonals);
    const Force force = estimate(pillar, diagonals, sum);

    const size_t index = row * pillar_cols + col;
    store_plane(force.shear_x, shear_x + index, count);
    store_plane(force.shear_y, shear_y + index, count);
    store_plane(force.normal, normal + index, count);
    store_status(status_of(pillar, sum), status + index, count);
#ifdef PF_ANGLES
    const Direction direction = direction_of(force);
    store_plane(direction.magnitude, magnitude + index, count);
    store_plane(direction.theta, theta + index, count);
    store_plane(direction.phi, phi + index, count);
#endif
#ifdef PF_UNCERTAINTY
    const RealPair noise_top = read_noise(first, planes, offset, count);
    const RealPair noise_bottom =
        read_noise(first + row_stride, planes, offset + planes.stride, count);
    const Noise noises = {noise_top.right, noise_top.left, noise_bottom.left, noise_bottom.right};
    const ForceScale scale = {(Real)(PF_SHEAR_SCALE), (Real)(PF_NORMAL_SCALE)};
    const Force deviations = force_deviations(pillar, diagonals, noises, scale);
    const DirectionInterval interval = direction_interval(pillar, diagonals, sum, scale);
    store_plane(deviations.shear_x, deviation_x + index, count);
    store_plane(deviations.shear_y, deviation_y + index, count);
    store_plane(deviations.normal, deviation_normal + index, count);
    store_plane(interval.theta_low, theta_low + index, count);
    store_plane(interval.theta_high, theta_high + index, count);
    store_plane(interval.phi_low, phi_low + index, count);
    store_plane(interval.phi_high, phi_high + index, count);
    store_plane(interval.magnitude_low, magnitude_low + index, count);
    store_plane(interval.magnitude_high, magnitude_high + index, count);
#endif
  }
}
