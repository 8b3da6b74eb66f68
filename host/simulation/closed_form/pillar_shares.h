#pragma once

#include <vector>

#include "simulation/closed_form/disc_integrals.h"
#include "simulation/closed_form/pillar_grid.h"

namespace pillarfield {

/// Fraction of a contact's load on each pillar of a box, row by row from the top left.
using Shares = std::vector<double>;

/// First moments of a load of 1 on each pillar of a box about its axis, mm.
using ShareMoments = std::vector<PlaneVector>;

/// A circular contact area.
struct Disc {
  PlaneVector centre_mm;
  double radius_mm;
};

/// Integrals over the cells of `box` of the traction with the corner function `corner`; zero
/// outside the disc. They add up to the load. Error: 1e-13 of the load.
[[nodiscard]] Shares disc_shares(const PillarGrid& grid, const PillarBox& box, const Disc& disc,
                                 CornerFunction corner);

/// First moments of the pressure with the corner function `corner`, by Gauss's rule with 8 nodes.
[[nodiscard]] ShareMoments disc_moments(const PillarGrid& grid, const PillarBox& box,
                                        const Disc& disc, CornerFunction corner);

/// The contact area of a cylinder whose axis is at right angles to the unit vector `direction`.
struct Strip {
  PlaneVector centre_mm;
  PlaneVector direction;
  double half_width_mm;
  double length_mm;
};

/// Integrals of the elliptical pressure under a cylinder (C17). Error: 1e-9 of the load.
[[nodiscard]] Shares strip_shares(const PillarGrid& grid, const PillarBox& box, const Strip& strip);

/// First moments of the elliptical pressure, as in disc_moments().
[[nodiscard]] ShareMoments strip_moments(const PillarGrid& grid, const PillarBox& box,
                                         const Strip& strip);

}  // namespace pillarfield
