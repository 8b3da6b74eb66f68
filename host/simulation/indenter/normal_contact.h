#pragma once

#include <optional>

#include "simulation/indenter/cells.h"
#include "simulation/indenter/half_space.h"

namespace pillarfield {

/// Frictionless contact of a rigid indenter with the half-space (H7).
struct NormalContact {
  double approach_mm = 0;  ///< depth of height 0 below the undeformed surface
  CellField pressure;      ///< over πE*, >= 0; the box contains the contact
  CellBox contact;         ///< box of the cells under pressure
  int iterations = 0;
};

/// Convergence tolerance, relative to the approach: RMS gap over the contact; three times as much
/// overlap in any cell outside.
inline constexpr double kGapTolerance = 1e-5;

/// Largest number of iterations; about 25 are usual.
inline constexpr int kMostPressIterations = 2000;

/// Finds the pressure whose sum over the cells is `sum` (> 0) under an indenter whose surface is
/// at `height_mm`, of any origin; infinite where there is no indenter. Bound-constrained conjugate
/// gradients of Polonsky and Keer (Wear 231, 1999, 206-219), on the cells that the indenter
/// reaches. The sum is met to rounding. Unset if no cell is below the indenter or
/// kMostPressIterations do not suffice.
[[nodiscard]] std::optional<NormalContact> solve_normal_contact(const CellField& height_mm,
                                                                double sum, HalfSpaces& surfaces);

}  // namespace pillarfield
