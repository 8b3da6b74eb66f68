#pragma once

#include <filesystem>

#include "pillarfield/output_file.h"
#include "testbed/testbed.h"

/// The paper's figures that can be computed, each drawn as SVG and PNG; see gnuplot.h. Every curve
/// comes from curves.h or from the experiment, gnuplot only draws.
namespace pillarfield::testbed {

/// Figure 3: where each sensel lifts, and the regions between these borders.
void draw_regions(const std::filesystem::path& stem, Replace replace = Replace::results);

/// Figure 4: what the two readings of region 3.12 leave open, for several of their ratios.
void draw_contours(const std::filesystem::path& stem, Replace replace = Replace::results);

/// Figure 5: half of what is left open, against the ratio of the readings.
void draw_uncertainty(const std::filesystem::path& stem, Replace replace = Replace::results);

/// Figure 8: magnitude calculated against magnitude applied, run 0 of the experiment.
void draw_magnitude(const std::filesystem::path& stem, const Parameters& parameters,
                    Replace replace = Replace::results);

/// Draws the four into `folder`, which is made where it is missing: figure_3_regions,
/// figure_4_contours, figure_5_uncertainty and figure_8_magnitude. Throws Error where gnuplot is
/// missing or fails, or the folder cannot be written.
void draw_figures(const std::filesystem::path& folder, const Parameters& parameters,
                  Replace replace = Replace::results);

}  // namespace pillarfield::testbed
