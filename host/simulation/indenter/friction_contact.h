#pragma once

#include "simulation/indenter/cells.h"
#include "simulation/indenter/half_space.h"

namespace pillarfield {

/// A tangential vector per cell of a box, x right and y up.
struct CellVectors {
  CellVectors() = default;
  explicit CellVectors(const CellBox& box) : x(box), y(box) {}

  [[nodiscard]] const CellBox& box() const { return x.box; }

  CellField x;
  CellField y;
};

/// Convergence tolerance: largest projected gradient of a cell over the largest |b|.
inline constexpr double kSlipTolerance = 1e-4;

/// Largest number of iterations; some tens are usual.
inline constexpr int kMostSlipIterations = 2000;

/// One step of Kalker's incremental problem (H9, H10): finds the shear over πE* that minimises
/// ½ q·Aq − q·b where |q| <= `limit` in every cell, A being HalfSpace::shear and b = `drive_mm` the
/// displacement of each cell from the undeformed surface if all stuck. A cell below its limit
/// sticks, one at its limit may slip. All have one box; `shear` is the initial guess and the
/// result. Returns the number of iterations, or −1 if kMostSlipIterations do not suffice.
[[nodiscard]] int solve_friction_contact(const CellField& limit, const CellVectors& drive_mm,
                                         HalfSpace& surface, CellVectors& shear);

}  // namespace pillarfield
