#pragma once

#include <cstdint>
#include <span>

#include "pillarfield/sensor_effects.h"

namespace pillarfield {

/// Overwrites readings, [rows, cols], by those of a scanned array with wires of some resistance:
/// the network of each tile is solved for every driven row. A sensel's conductance is its reading
/// before, at least zero. In a tile of r rows and c columns the cost is r²(r + c) operations.
///
/// Row i is at 1 V before its resistance R_i; all other rows (R_j) and all columns (C) are at 0 V
/// behind theirs. With conductances g and their sums over a row, a_r, and over a column, b_c, the
/// potentials u of the rows' sensels satisfy u + R w = e_i with the currents
///
///     w = L u,   L = diag(a) − g diag(C/(1 + C b)) gᵀ,
///
/// the columns being eliminated. Only R_i differs from row to row, so one inverse M = (1 + R_j L)⁻¹
/// serves all: u = M e_i / (1 − (R_j − R_i)(L M)_ii). Column c reads Σ_r g_rc u_r / (1 + C b_c).
void read_through_wires(const WireCrosstalk& wires, std::uint32_t rows, std::uint32_t cols,
                        std::span<double> readings);

}  // namespace pillarfield
