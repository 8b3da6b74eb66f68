#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/wide.h"

namespace pillarfield {

/// atan2(y, x) for x >= 0, zero at the origin, within 3e-16, without branches, so that compilers
/// vectorise loops of it. atan t = atan c + atan((t - c) / (1 + tc)) with c of 0, tan(pi/8) or 1
/// leaves at most pi/16 to the Taylor series.
PF_WIDE_INLINE double arc(double y, double x) {
  using std::numbers::pi;
  constexpr double kTan1 = 0.19891236737965800691;  // tan(pi/16)
  constexpr double kTan2 = 0.41421356237309504880;  // tan(pi/8)
  constexpr double kTan3 = 0.66817863791929891999;  // tan(3 pi/16)
  const double rise = std::abs(y);
  const double less = std::min(rise, x);
  const double more = std::max(rise, x);
  const double c = less > kTan3 * more ? 1 : (less > kTan1 * more ? kTan2 : 0);
  const double base = less > kTan3 * more ? pi / 4 : (less > kTan1 * more ? pi / 8 : 0);
  const double u = (less - c * more) / std::max(more + c * less, 1e-300);
  const double q = -u * u;
  const double late =
      1.0 / 13 + q * (1.0 / 15 + q * (1.0 / 17 + q * (1.0 / 19 + q * (1.0 / 21 + q * (1.0 / 23)))));
  const double series =
      1 + q * (1.0 / 3 + q * (1.0 / 5 + q * (1.0 / 7 + q * (1.0 / 9 + q * (1.0 / 11 + q * late)))));
  const double angle = base + u * series;
  return std::copysign(rise > x ? pi / 2 - angle : angle, y);
}

}  // namespace pillarfield
