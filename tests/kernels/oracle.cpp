#include "oracle.h"

#include <cstddef>
#include <utility>

namespace pillarfield::oracle {
namespace {

/// Unknowns: F sin(theta) cos(phi), F sin(theta) sin(phi), F cos(theta).
using Row = std::array<Exact, 3>;

Exact sensel_angle(std::size_t sensel) {
  return exact::pi() / 4 * static_cast<int>(2 * sensel + 1);
}

/// What equation (2) multiplies the unknowns of sensel 0..3 by, but for k.
const std::array<Row, 4>& model_rows() {
  static const std::array<Row, 4> rows = [] {
    std::array<Row, 4> made;
    for (std::size_t n = 0; n < 4; ++n) {
      made[n] = {-exact::cos(sensel_angle(n)), -exact::sin(sensel_angle(n)), 1};
    }
    return made;
  }();
  return rows;
}

/// Solves a square system given as rows of coefficients and right-hand side.
template <std::size_t kSize>
std::array<Exact, kSize> eliminate(std::array<std::array<Exact, kSize + 1>, kSize> rows) {
  for (std::size_t col = 0; col < kSize; ++col) {
    std::size_t pivot = col;
    for (std::size_t row = col + 1; row < kSize; ++row) {
      if (exact::abs(rows[row][col]) > exact::abs(rows[pivot][col])) pivot = row;
    }
    std::swap(rows[col], rows[pivot]);
    for (std::size_t row = 0; row < kSize; ++row) {
      if (row == col) continue;
      const Exact factor = rows[row][col] / rows[col][col];
      for (std::size_t i = col; i <= kSize; ++i) rows[row][i] -= factor * rows[col][i];
    }
  }
  std::array<Exact, kSize> solution;
  for (std::size_t i = 0; i < kSize; ++i) solution[i] = rows[i][kSize] / rows[i][i];
  return solution;
}

/// The force that gives the two usable readings when its normal component is `normal`.
Force force_at_normal(const SomeReadings& usable, Exact k, Exact normal) {
  std::array<std::array<Exact, 3>, 2> rows;
  std::size_t filled = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    if (!usable[n]) continue;
    const Row& row = model_rows()[n];
    rows[filled++] = {row[0], row[1], *usable[n] / k - row[2] * normal};
  }
  const std::array<Exact, 2> from = eliminate<2>(rows);
  return {-from[0], -from[1], normal};
}

bool explains_lifted(const SomeReadings& usable, const Force& force, Exact k) {
  const Readings readings = readings_of(force, k);
  for (std::size_t n = 0; n < 4; ++n) {
    if (!usable[n] && readings[n] > 0) return false;
  }
  return true;
}

}  // namespace

Exact magnitude(const Force& force) {
  return exact::sqrt(force.shear_x * force.shear_x + force.shear_y * force.shear_y +
                     force.normal * force.normal);
}

Force force_from(Exact magnitude, Exact theta, Exact phi) {
  const Exact shear = magnitude * exact::sin(theta);
  return {-shear * exact::cos(phi), -shear * exact::sin(phi), magnitude * exact::cos(theta)};
}

Readings readings_from(Exact magnitude, Exact theta, Exact phi, Exact k) {
  Readings readings;
  for (std::size_t n = 0; n < 4; ++n) {
    readings[n] =
        magnitude * k * (exact::cos(theta) - exact::sin(theta) * exact::cos(sensel_angle(n) - phi));
  }
  return readings;
}

Readings readings_of(const Force& force, Exact k) {
  Readings readings;
  for (std::size_t n = 0; n < 4; ++n) {
    const Row& row = model_rows()[n];
    readings[n] = k * (-row[0] * force.shear_x - row[1] * force.shear_y + row[2] * force.normal);
  }
  return readings;
}

Force least_squares(const SomeReadings& usable, Exact k) {
  std::array<std::array<Exact, 4>, 3> normal_equations{};
  for (std::size_t n = 0; n < 4; ++n) {
    if (!usable[n]) continue;
    const Row& row = model_rows()[n];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) normal_equations[i][j] += row[i] * row[j];
      normal_equations[i][3] += row[i] * *usable[n];
    }
  }
  const std::array<Exact, 3> from = eliminate<3>(normal_equations);
  return {-from[0] / k, -from[1] / k, from[2] / k};
}

Segment segment_of(const SomeReadings& usable, Exact k) {
  Exact low = 0;
  Exact high = 0;
  for (const std::optional<Exact>& reading : usable) high += reading.value_or(0) / k;
  for (int step = 0; step < 115; ++step) {
    const Exact middle = (low + high) / 2;
    (explains_lifted(usable, force_at_normal(usable, k, middle), k) ? low : high) = middle;
  }
  return {force_at_normal(usable, k, 0), force_at_normal(usable, k, low)};
}

}  // namespace pillarfield::oracle
