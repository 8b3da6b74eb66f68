#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"
#include "testbed/testbed.h"

namespace pillarfield::testbed {

/// Draws figures of the paper as SVG and PNG into `folder`, which is created if missing. curves.h
/// and the experiment compute all curves. Throws Error where gnuplot is missing or fails, or the
/// folder cannot be written. The figures:
///
///     figure_3_regions      borders of the sensels, and the regions between them
///     figure_4_contours     directions that the readings of region 3.12 allow, for several ratios
///     figure_5_uncertainty  half-width of that range against the ratio
///     figure_8_magnitude    calculated against applied magnitude, run 0 of the experiment
void draw_figures(const std::filesystem::path& folder, const Parameters& parameters,
                  Replace replace = Replace::results);

}  // namespace pillarfield::testbed
