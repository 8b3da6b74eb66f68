#include "tests/kernels/oracle.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace pillarfield::exact {
namespace {

/// x - x^3/3! + ... or, from first = 1, 1 - x^2/2! + ...: `power` is the first term's.
Exact alternating_series(Exact x, Exact first, int power) {
  Exact sum = first;
  Exact term = first;
  for (int n = power + 1; n < power + 120; n += 2) {
    term *= -x * x / (n * (n + 1));
    sum += term;
  }
  return sum;
}

Exact atan_of_inverse(int denominator) {
  Exact power = Exact(1) / denominator;
  Exact sum = power;
  for (int n = 3; n < 200; n += 2) {
    power /= -denominator * denominator;
    sum += power / n;
  }
  return sum;
}

Exact reduced(Exact x) {
  while (x > pi()) x -= 2 * pi();
  while (x < -pi()) x += 2 * pi();
  return x;
}

}  // namespace

Exact pi() {
  static const Exact value = 4 * (4 * atan_of_inverse(5) - atan_of_inverse(239));
  return value;
}

Exact sin(Exact x) {
  const Exact angle = reduced(x);
  return alternating_series(angle, angle, 1);
}

Exact cos(Exact x) { return alternating_series(reduced(x), 1, 0); }

Exact sqrt(Exact x) {
  if (x <= 0) return 0;
  Exact root = std::sqrt(static_cast<double>(x));
  for (int step = 0; step < 3; ++step) root = (root + x / root) / 2;
  return root;
}

Exact atan2(Exact y, Exact x) {
  // The first guess is a double's, whose range is less than what arguments may have.
  const Exact largest = abs(x) > abs(y) ? abs(x) : abs(y);
  x /= largest;
  y /= largest;
  const Exact radius = sqrt(x * x + y * y);
  Exact angle = std::atan2(static_cast<double>(y), static_cast<double>(x));
  for (int step = 0; step < 2; ++step) {
    // The sine of what is missing: its cube is below the last bit from the second step on.
    const Exact missing = (y * cos(angle) - x * sin(angle)) / radius;
    angle += missing + missing * missing * missing / 6;
  }
  return angle;
}

}  // namespace pillarfield::exact

namespace pillarfield::oracle {
namespace {

/// Unknowns: F sin(theta) cos(phi), F sin(theta) sin(phi), F cos(theta).
using Row = std::array<Exact, 3>;

/// Coefficients of equation (2) for sensel 0..3, without k.
const std::array<Row, 4>& model_rows() {
  static const std::array<Row, 4> rows = [] {
    std::array<Row, 4> made{};
    for (std::size_t n = 0; n < 4; ++n) {
      made[n] = {-exact::cos(sensel_angle(n)), -exact::sin(sensel_angle(n)), 1};
    }
    return made;
  }();
  return rows;
}

/// Solves a square system given as rows of coefficients and right-hand side.
template <std::size_t size>
std::array<Exact, size> eliminate(std::array<std::array<Exact, size + 1>, size> rows) {
  for (std::size_t col = 0; col < size; ++col) {
    std::size_t pivot = col;
    for (std::size_t row = col + 1; row < size; ++row) {
      if (exact::abs(rows[row][col]) > exact::abs(rows[pivot][col])) pivot = row;
    }
    std::swap(rows[col], rows[pivot]);
    for (std::size_t row = 0; row < size; ++row) {
      if (row == col) continue;
      const Exact factor = rows[row][col] / rows[col][col];
      for (std::size_t i = col; i <= size; ++i) rows[row][i] -= factor * rows[col][i];
    }
  }
  std::array<Exact, size> solution{};
  for (std::size_t i = 0; i < size; ++i) solution[i] = rows[i][size] / rows[i][i];
  return solution;
}

/// One linear equation of the unknowns.
struct Equation {
  Row row;
  Exact value;
};

/// Equations of the usable readings, and equal readings of two opposite inactive sensels.
std::vector<Equation> equations_of(const SomeReadings& usable, Exact k) {
  std::vector<Equation> equations;
  for (std::size_t n = 0; n < 4; ++n) {
    if (usable[n]) equations.push_back({model_rows()[n], *usable[n] / k});
  }
  for (std::size_t n = 0; n < 2; ++n) {
    if (usable[n] || usable[n + 2]) continue;
    const Row& p = model_rows()[n];
    const Row& q = model_rows()[n + 2];
    equations.push_back({{p[0] - q[0], p[1] - q[1], p[2] - q[2]}, 0});
  }
  return equations;
}

/// The normal equations of three or more, eliminated.
Force best_fit(const std::vector<Equation>& equations) {
  std::array<std::array<Exact, 4>, 3> normal_equations{};
  for (const auto& [row, value] : equations) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) normal_equations[i][j] += row[i] * row[j];
      normal_equations[i][3] += row[i] * value;
    }
  }
  const std::array<Exact, 3> from = eliminate<3>(normal_equations);
  return {-from[0], -from[1], from[2]};
}

/// The force that fulfils two equations when its normal component is `normal`.
Force force_at_normal(const std::vector<Equation>& equations, Exact normal) {
  std::array<std::array<Exact, 3>, 2> rows{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& [row, value] = equations[i];
    rows[i] = {row[0], row[1], value - row[2] * normal};
  }
  const std::array<Exact, 2> from = eliminate<2>(rows);
  return {-from[0], -from[1], normal};
}

bool explains_zero(const SomeReadings& usable, const Force& force, Exact k, Exact hidden) {
  const Readings readings = readings_of(force, k);
  for (std::size_t n = 0; n < 4; ++n) {
    if (!usable[n] && readings[n] > hidden) return false;
  }
  return true;
}

/// The force a part of the way from the low to the high end.
Force point_of(const Segment& segment, Exact part) {
  const auto between = [&](Exact low, Exact high) { return low + part * (high - low); };
  return {between(segment.low.shear_x, segment.high.shear_x),
          between(segment.low.shear_y, segment.high.shear_y),
          between(segment.low.normal, segment.high.normal)};
}

/// `usable` with one reading changed by a share of itself.
SomeReadings changed(SomeReadings usable, std::size_t sensel, Exact share) {
  usable[sensel] = *usable[sensel] * (1 + share);
  return usable;
}

}  // namespace

Exact sensel_angle(std::size_t sensel) {
  return exact::pi() / 4 * static_cast<int>(2 * sensel + 1);
}

Exact magnitude(const Force& force) {
  return exact::sqrt(force.shear_x * force.shear_x + force.shear_y * force.shear_y +
                     force.normal * force.normal);
}

Force force_from(Exact magnitude, Exact theta, Exact phi) {
  const Exact shear = magnitude * exact::sin(theta);
  return {-shear * exact::cos(phi), -shear * exact::sin(phi), magnitude * exact::cos(theta)};
}

Readings readings_from(Exact magnitude, Exact theta, Exact phi, Exact k) {
  Readings readings{};
  for (std::size_t n = 0; n < 4; ++n) {
    readings[n] =
        magnitude * k * (exact::cos(theta) - exact::sin(theta) * exact::cos(sensel_angle(n) - phi));
  }
  return readings;
}

Readings readings_of(const Force& force, Exact k) {
  Readings readings{};
  for (std::size_t n = 0; n < 4; ++n) {
    const Row& row = model_rows()[n];
    readings[n] = k * (-row[0] * force.shear_x - row[1] * force.shear_y + row[2] * force.normal);
  }
  return readings;
}

Force least_squares(const SomeReadings& usable, Exact k) {
  return best_fit(equations_of(usable, k));
}

Segment segment_of(const SomeReadings& usable, Exact k, Exact hidden) {
  const std::vector<Equation> equations = equations_of(usable, k);
  Exact low = 0;
  Exact high = hidden / k;
  for (const std::optional<Exact>& reading : usable) high += reading.value_or(0) / k;
  for (int step = 0; step < 115; ++step) {
    const Exact middle = (low + high) / 2;
    const Force force = force_at_normal(equations, middle);
    (explains_zero(usable, force, k, hidden) ? low : high) = middle;
  }
  return {force_at_normal(equations, 0), force_at_normal(equations, low)};
}

Force direct_force(const SomeReadings& usable, Exact k, Exact hidden, Exact segment_point) {
  const auto count = std::ranges::count_if(usable, [](const auto& v) { return v.has_value(); });
  if (count == 0) return {0, 0, 0};
  const bool whole_diagonal = (usable[0] && usable[2]) || (usable[1] && usable[3]);
  if (whole_diagonal) return least_squares(usable, k);
  return point_of(segment_of(usable, k, hidden), count == 2 ? segment_point : Exact{1} / 2);
}

double condition_number(const SomeReadings& usable, const Estimate& estimate) {
  const Exact step = 0x1p-40;
  const Force force = estimate(usable);
  std::array<Exact, 3> sums{};
  for (std::size_t n = 0; n < 4; ++n) {
    if (!usable[n]) continue;
    const Force up = estimate(changed(usable, n, step));
    const Force down = estimate(changed(usable, n, -step));
    const auto largest = [&](Exact Force::*component) {
      return std::max(exact::abs(up.*component - force.*component),
                      exact::abs(down.*component - force.*component));
    };
    sums[0] += largest(&Force::shear_x);
    sums[1] += largest(&Force::shear_y);
    sums[2] += largest(&Force::normal);
  }
  const Exact worst = std::max({sums[0], sums[1], sums[2]});
  return static_cast<double>(worst / step / magnitude(force));
}

}  // namespace pillarfield::oracle
