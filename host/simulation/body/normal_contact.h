#pragma once

#include <optional>

#include "simulation/body/cells.h"
#include "simulation/body/half_space.h"

namespace pillarfield {

/// How a rigid body without friction lies on the half-space under a load (H7).
struct NormalContact {
  double approach_mm = 0;  ///< how far height 0 is below the undeformed surface
  CellField pressure;      ///< over πE*, zero or more; its box holds the whole contact
  CellBox contact;         ///< the cells that bear pressure
  int iterations = 0;
};

/// Gaps and overlaps that are left may be that part of the approach: the root mean square over the
/// contact, and three times as much in any single cell outside.
inline constexpr double kGapTolerance = 1e-5;

/// Iterations that are tried; some 25 are usual.
inline constexpr int kMostPressIterations = 2000;

/// Finds the pressure whose sum over the cells is `sum` (> 0) under a body whose surface is
/// at `height_mm`, of any origin; infinite where there is no body. Bound-constrained conjugate
/// gradients of Polonsky and Keer (Wear 231, 1999, 206-219), on the cells that the body reaches.
/// The sum is met to rounding. Unset where no cell is below the body, or where
/// kMostPressIterations did not suffice.
[[nodiscard]] std::optional<NormalContact> solve_normal_contact(const CellField& height_mm,
                                                                double sum, HalfSpaces& surfaces);

}  // namespace pillarfield
