#pragma once

#include <array>

#include "testbed/testbed.h"

namespace pillarfield::testbed {

/// A range of magnitudes, N.
struct MagnitudeBand {
  double low;
  double high;
};

/// What uncertain angles make of an applied force of 1 N: the least and the largest magnitude that
/// equation (2) fits to the readings of the site's force when the angles put into it are off by up
/// to `uncertainty_rad` each. With the bracket g_n of (2) at these angles, the magnitude that fits
/// best is the sum of V_n g_n over k times the sum of g_n², over the sensels usable at the site
/// (docs/testbed.md). The bounds come from a grid of 41 by 41 pairs of angles.
[[nodiscard]] MagnitudeBand magnitude_band(const Site& site, double uncertainty_rad);

/// A point of Figure 8.
struct MagnitudePoint {
  double applied_n;
  MagnitudeBand uncertain;  ///< the grey band of the figure
  double paper_n;
  double direct_n;
  MagnitudeBand possible;  ///< the interval of `direct`; a point where it is determined
  bool ambiguous;          ///< by the status byte of `direct`
};

/// Figure 8, site by site in the order of kSites.
using MagnitudeFigure = std::array<std::array<MagnitudePoint, kAppliedN.size()>, kSites.size()>;

/// The magnitudes calculated in run 0 of the experiment.
[[nodiscard]] MagnitudeFigure magnitude_figure(const Parameters& parameters);

}  // namespace pillarfield::testbed
