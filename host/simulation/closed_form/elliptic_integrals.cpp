#include "simulation/closed_form/elliptic_integrals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/wide.h"

namespace pillarfield {
namespace {

/// R_F of arguments that nearly agree: Taylor series about their mean (DLMF 19.36.1).
PF_WIDE_INLINE double first_near_mean(double x, double y, double z) {
  const double mean = (x + y + z) / 3;
  const double u = 1 - x / mean;
  const double v = 1 - y / mean;
  const double w = -(u + v);
  const double e2 = u * v - w * w;
  const double e3 = u * v * w;
  return (1 - e2 / 10 + e3 / 14 + e2 * e2 / 24 - 3 * e2 * e3 / 44) / std::sqrt(mean);
}

/// R_D of arguments that nearly agree (DLMF 19.36.2).
PF_WIDE_INLINE double second_near_mean(double x, double y, double z) {
  const double mean = (x + y + 3 * z) / 5;
  const double u = 1 - x / mean;
  const double v = 1 - y / mean;
  const double w = -(u + v) / 3;
  const double uv = u * v;
  const double ww = w * w;
  const double e2 = uv - 6 * ww;
  const double e3 = (3 * uv - 8 * ww) * w;
  const double e4 = 3 * (uv - ww) * ww;
  const double e5 = uv * ww * w;
  const double series =
      1 - 3 * e2 / 14 + e3 / 6 + 9 * e2 * e2 / 88 - 3 * e4 / 22 - 9 * e2 * e3 / 52 + 3 * e5 / 26;
  return series / (mean * std::sqrt(mean));
}

/// Whether the series have converged in all lanes: their error is the sixth power of the spread.
PF_WIDE_INLINE bool nearly_agree(const CarlsonArguments& at) {
  constexpr double kSpread = 3e-3;
  double excess = 0;
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    const double most = std::max(at.x[i], std::max(at.y[i], at.z[i]));
    const double least = std::min(at.x[i], std::min(at.y[i], at.z[i]));
    excess = std::max(excess, most - (1 + kSpread) * least);
  }
  return excess <= 0;
}

}  // namespace

PF_WIDE void carlson_integrals(CarlsonArguments at, CarlsonLanes& first, CarlsonLanes& second) {
  CarlsonLanes sum{};
  double weight = 1;
  while (!nearly_agree(at)) {
    for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
      const double root_x = std::sqrt(at.x[i]);
      const double root_y = std::sqrt(at.y[i]);
      const double root_z = std::sqrt(at.z[i]);
      const double lambda = root_x * root_y + root_y * root_z + root_z * root_x;
      sum[i] += weight / (root_z * (at.z[i] + lambda));
      at.x[i] = (at.x[i] + lambda) / 4;
      at.y[i] = (at.y[i] + lambda) / 4;
      at.z[i] = (at.z[i] + lambda) / 4;
    }
    weight /= 4;
  }
  for (std::size_t i = 0; i < kCarlsonLanes; ++i) {
    first[i] = first_near_mean(at.x[i], at.y[i], at.z[i]);
    second[i] = 3 * sum[i] + weight * second_near_mean(at.x[i], at.y[i], at.z[i]);
  }
}

CarlsonIntegrals carlson_integrals(double x, double y, double z) {
  CarlsonArguments at{};
  at.x.fill(x);
  at.y.fill(y);
  at.z.fill(z);
  CarlsonLanes first;
  CarlsonLanes second;
  carlson_integrals(at, first, second);
  return {first[0], second[0]};
}

}  // namespace pillarfield
