#pragma once

#include "simulation/body/cells.h"
#include "simulation/body/half_space.h"

namespace pillarfield {

/// A vector in the plane of the skin for each cell of a box, x right and y up.
struct CellVectors {
  CellVectors() = default;
  explicit CellVectors(const CellBox& box) : x(box), y(box) {}

  [[nodiscard]] const CellBox& box() const { return x.box; }

  CellField x;
  CellField y;
};

/// Shear is final when no cell can come closer to balance by more than this part of the largest
/// displacement that is asked for.
inline constexpr double kSlipTolerance = 1e-4;

/// Iterations that are tried; some tens are usual.
inline constexpr int kMostSlipIterations = 2000;

/// One step of Kalker's incremental problem (H9, H10): finds the shear over πE* that minimises
/// ½ q·Aq − q·b where |q| <= `limit` in every cell, A being HalfSpace::shear and `drive_mm` = b how
/// far the body would drag each cell if all stuck, counted from the undeformed surface. Then a cell
/// below its limit moves with the body, and one at its limit slips against it. All have the same
/// box; `shear` holds a guess before and the answer after. Gives the number of iterations, or −1
/// where kMostSlipIterations did not suffice.
[[nodiscard]] int solve_friction_contact(const CellField& limit, const CellVectors& drive_mm,
                                         HalfSpace& surface, CellVectors& shear);

}  // namespace pillarfield
