/* Changes the tare with the curvature of the skin before a frame is solved
 * (docs/derivations/sensor_effects.md, E8). Stage PF_BEND. */
#ifdef PF_BEND

/* Updates the tares of one row of sensels under PF_LANES pillars; writes those of `lanes`. */
PF_INLINE void bend_row(Calibration calibration, Place place, Curvature change, Lanes lanes) {
  const size_t offset = offset_of(calibration, place);
  const CorrectionPair at = load_corrections(calibration, place);
  const RealPair x = load_plane(PF_PLANE_OF(calibration, float, PF_BEND_X_PLANE) + offset);
  const RealPair y = load_plane(PF_PLANE_OF(calibration, float, PF_BEND_Y_PLANE) + offset);
  const RealPair xy = load_plane(PF_PLANE_OF(calibration, float, PF_BEND_XY_PLANE) + offset);
  const RealPair tares = {bent_tare(at.left.tare, x.left, y.left, xy.left, change),
                          bent_tare(at.right.tare, x.right, y.right, xy.right, change)};
  store_tares(tares, calibration, place, at, lanes);
}

/* Adds a change of curvature, 1/mm. A work-item updates blocks as in follow_baseline. */
kernel void bend_tare(global const PF_SENSEL* restrict raw, global uchar* restrict calibration,
                      global uchar* restrict results, Layout layout,
                      constant PlanNumbers* restrict numbers, float x, float y, float xy) {
  const Calibration planes = calibration_of(calibration, results, layout, numbers);
  const Curvature change = {x, y, xy};
  const uint cols = (uint)layout.cols;
  const Band band = band_of_rows((uint)layout.rows);
  const uint step = (uint)get_global_size(0) * PF_LANES;
  for (uint row = 2 * band.first; row < 2 * band.end; ++row) {
    for (uint at = (uint)get_global_id(0) * PF_LANES; at < cols; at += step) {
      const uint col = min(at, cols - PF_LANES);
      const Place place = {row, 2 * col};
      const Lanes lanes = {at - col, PF_LANES};
      bend_row(planes, place, change, lanes);
    }
  }
}

#endif
