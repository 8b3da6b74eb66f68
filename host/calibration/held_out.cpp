#include "calibration/held_out.h"

#include <algorithm>
#include <cmath>

#include "skin/pillar_sensels.h"

namespace pillarfield {
namespace {

HeldOutLevel compare(const ResponseFit& fit, const ResponseFit& all, double level,
                     const std::vector<std::uint8_t>& mask) {
  HeldOutLevel held;
  double count = 0;
  for_each_solved_sensel(all.presses().front().frames.skin(), [&](std::size_t i) {
    if (!mask.empty() && mask[i] != kGood) return;
    const Response fitted = fit(i);
    if (fitted.kind != Response::Kind::good) return;
    for (const UniformPress& press : all.presses()) {
      if (press.pressure_kpa != level) continue;
      const auto response = all.response(press, i);
      if (!response) continue;
      const double force_n = all.force_n(press, i);
      const double residual = fit.force_at(fitted, *response) - force_n;
      held.force_n += force_n;
      held.mean_square += residual * residual;
      ++count;
    }
  });
  if (count > 0) held = {held.force_n / count, held.mean_square / count};
  return held;
}

}  // namespace

std::optional<ResponseFit> fit_of(ResponseModel kind, std::span<const UniformPress> presses,
                                  const Calibration& planes,
                                  const std::vector<std::uint8_t>& mask) {
  ResponseFit fit(presses, planes);
  if (kind == ResponseModel::linear) return fit;
  if (fit.levels().size() < 2) return std::nullopt;
  const auto at = level_readings(fit, mask);
  if (!at) return std::nullopt;
  fit.straighten(fit_common_response(at->forces_n, at->readings), at->forces_n.back(),
                 at->readings.back());
  return fit;
}

std::vector<HeldOutLevel> hold_out(ResponseModel kind, const ResponseFit& all,
                                   const std::vector<std::uint8_t>& mask) {
  std::vector<HeldOutLevel> levels;
  for (std::size_t i = 1; i + 1 < all.levels().size(); ++i) {
    const double level = all.levels()[i];
    std::vector<UniformPress> others;
    for (const UniformPress& press : all.presses()) {
      if (press.pressure_kpa != level) others.push_back(press);
    }
    const auto fit = fit_of(kind, others, all.planes(), mask);
    if (!fit) return {};
    levels.push_back(compare(*fit, all, level, mask));
  }
  return levels;
}

std::optional<double> relative_residual(const std::vector<HeldOutLevel>& levels) {
  double residuals = 0;
  double forces = 0;
  for (const HeldOutLevel& level : levels) {
    residuals += level.mean_square;
    forces += level.force_n * level.force_n;
  }
  return forces > 0 ? std::optional(std::sqrt(residuals / forces)) : std::nullopt;
}

std::optional<ResidualError> residual_error(const std::vector<HeldOutLevel>& levels,
                                            double counts_per_newton) {
  // Least squares of 1 = a o² + b r² over the levels, a = 1/m and b = force²/m, m the mean square.
  double aa = 0;
  double ab = 0;
  double bb = 0;
  double a_sum = 0;
  double b_sum = 0;
  for (const HeldOutLevel& level : levels) {
    if (level.mean_square <= 0) continue;
    const double a = 1 / level.mean_square;
    const double b = level.force_n * level.force_n / level.mean_square;
    aa += a * a;
    ab += a * b;
    bb += b * b;
    a_sum += a;
    b_sum += b;
  }
  if (!(bb > 0)) return std::nullopt;
  const double determinant = aa * bb - ab * ab;
  double offset = levels.size() > 1 ? (a_sum * bb - b_sum * ab) / determinant : 0;
  double relative = levels.size() > 1 ? (b_sum * aa - a_sum * ab) / determinant : b_sum / bb;
  if (!(offset > 0)) relative = b_sum / bb, offset = 0;
  if (!(relative > 0)) offset = a_sum / aa, relative = 0;
  return ResidualError{std::min(1.0, std::sqrt(relative)), counts_per_newton * std::sqrt(offset)};
}

}  // namespace pillarfield
