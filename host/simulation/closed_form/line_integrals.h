#pragma once

#include <array>

namespace pillarfield {

/// A point in the frame of a line contact: `across` its axis and `along` it, from its centre, mm.
struct LinePoint {
  double across;
  double along;
};

/// The force on a cell under a line contact of load 1: the integral of
/// p = 2 sqrt(1 − across²/a²) / (pi a L) over the part of the cell where |across| <= a = half_width
/// and |along| <= L/2, by Green's theorem (C17)-(C19). `cell` has its corners counter-clockwise,
/// at any rotation. Zero outside the contact. Error: 1e-9. Cost: about 0.1 µs.
[[nodiscard]] double line_share(const std::array<LinePoint, 4>& cell, double half_width,
                                double length);

}  // namespace pillarfield
