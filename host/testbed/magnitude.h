#pragma once

#include <array>

#include "testbed/testbed.h"

namespace pillarfield::testbed {

/// A range of magnitudes, N.
struct MagnitudeBand {
  double low;
  double high;
};

/// Returns the range of magnitudes calculated from an applied force of 1 N when both angles are off
/// by at most `uncertainty_rad`. With the brackets g_n of equation (2) at these angles, the
/// magnitude is sum(V_n g_n) / (k sum(g_n²)) over the usable sensels of the site (docs/testbed.md).
/// The bounds come from a grid of 41 by 41 pairs of angles.
[[nodiscard]] MagnitudeBand magnitude_band(const Site& site, double uncertainty_rad);

/// A point of Figure 8.
struct MagnitudePoint {
  double applied_n;
  MagnitudeBand uncertain;  ///< the grey band of the figure
  double paper_n;
  double direct_n;
  MagnitudeBand possible;  ///< interval of `direct`; a point where the force is determined
  bool ambiguous;          ///< by the status byte of `direct`
};

/// Figure 8 by site, in the order of kSites.
using MagnitudeFigure = std::array<std::array<MagnitudePoint, kAppliedN.size()>, kSites.size()>;

/// The magnitudes calculated in run 0 of the experiment.
[[nodiscard]] MagnitudeFigure magnitude_figure(const Parameters& parameters);

}  // namespace pillarfield::testbed
