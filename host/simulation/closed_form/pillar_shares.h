#pragma once

#include <vector>

#include "simulation/closed_form/disc_integrals.h"
#include "simulation/closed_form/pillar_grid.h"

namespace pillarfield {

/// The share of a contact's load that each pillar of a box takes, row by row from the top left.
using Shares = std::vector<double>;

/// A circular contact area.
struct Disc {
  PlaneVector centre_mm;
  double radius_mm;
};

/// Integrals over the cells of `box` of the traction on a disc that `corner` stands for; zero where
/// a cell does not meet the disc. Exact to 1e-13 of the load; they add up to the whole of it.
[[nodiscard]] Shares disc_shares(const PillarGrid& grid, const PillarBox& box, const Disc& disc,
                                 CornerFunction corner);

/// The contact area of a cylinder whose axis lies across `direction`, a unit vector.
struct Strip {
  PlaneVector centre_mm;
  PlaneVector direction;
  double half_width_mm;
  double length_mm;
};

/// The same for the elliptical pressure under a cylinder (C17). Exact to 1e-9 of the load.
[[nodiscard]] Shares strip_shares(const PillarGrid& grid, const PillarBox& box, const Strip& strip);

}  // namespace pillarfield
