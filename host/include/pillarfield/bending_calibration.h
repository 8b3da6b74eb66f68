#pragma once

#include <span>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Curvature around a cylinder of this radius, mm (below zero: inside of one), whose axis has the
/// angle axis_deg from +x, counter-clockwise: (sin² a, cos² a, −2 sin a cos a) / radius.
[[nodiscard]] Curvature curvature_of_cylinder(double radius_mm, double axis_deg);

/// Frames of the skin on a known shape, with nothing touching it.
struct BentSkin {
  const FrameStatistics& frames;
  Curvature curvature;
};

/// The result of calibrate_bending().
struct BendingResult {
  SkinCalibration calibration;
  bool found = false;             ///< whether the patterns exceed their errors
  double rms[3] = {};             ///< of bend_x, bend_y, bend_xy over the good sensels, counts·mm
  double standard_error[3] = {};  ///< of a sensel's bend_x, bend_y, bend_xy, RMS, counts·mm
  double residual_before = 0;     ///< RMS of the tare's change over sensels and shapes, counts
  double residual_after = 0;      ///< what the patterns leave of it
};

/// Fits the patterns Calibration::bend_x, bend_y and bend_xy: mean − tare = bend_x·x + bend_y·y +
/// bend_xy·xy, by least squares over the shapes. bend_xy is zero if no shape has a curvature xy.
/// Stores none if their mean square is below 1.2 times that of their errors. `before` must have the
/// tare of the flat skin and its noise; everything but the patterns is kept. Formulas and limits:
/// docs/calibration.md. Throws Error if the shapes do not determine the patterns, or sensels are at
/// full scale.
[[nodiscard]] BendingResult calibrate_bending(const SkinCalibration& before,
                                              std::span<const BentSkin> shapes);

}  // namespace pillarfield
