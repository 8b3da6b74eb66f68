#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// Factors by which the wires of a plan act on the readings of a frame, as
/// kernels/frame/find_wires.cl finds them; nothing if the plan has no crosstalk of wires.
class WireFactors {
 public:
  WireFactors() = default;
  /// `tares` are those of the frame; with TareOrigin::offset they do not load the wires.
  WireFactors(const SolverPlan& plan, const FrameView& frame, std::span<const float> tares);

  /// Wires of a sensel; meaningless outside the pillars, and without crosstalk.
  [[nodiscard]] single_precision::Wires at(std::size_t row, std::size_t col) const;

 private:
  /// Finds the factors of the tile whose first sensel is at (row, col).
  void find_tile(const SolverPlan& plan, const FrameView& frame, std::span<const float> offsets,
                 std::size_t row, std::size_t col);

  WireCrosstalk wires_;
  std::size_t rows_ = 0;  ///< sensels under pillars; 0: no crosstalk
  std::size_t cols_ = 0;
  std::vector<single_precision::RowWires> row_factors_;  ///< [tiles across, rows]
  std::vector<float> column_gains_;                      ///< [tiles down, columns]
};

}  // namespace pillarfield
