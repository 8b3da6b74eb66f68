#include "calibration/common_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "calibration/golden_section.h"
#include "calibration/normal_equations.h"

namespace pillarfield {
namespace {

/// Least number of forces from which a dead zone is fitted beside an exponent and a factor.
constexpr std::size_t kLeastForDeadZone = 4;
/// Largest fitted dead zone as a fraction of the smallest force.
constexpr double kMostDeadZone = 0.98;
/// The power law stays where a bent curve does not lower the squares by this factor, and where it
/// leaves this relative error, root mean square.
constexpr double kBentWins = 0.25;
constexpr double kGoodFit = 5e-4;
/// Most forces between which knots are added.
constexpr std::size_t kMostRefined = 30;

/// log(force − dead zone) along a line in log(reading), the power law, or bent by a term in the
/// reading too, with which a response saturates or stiffens.
struct Shape {
  double dead_zone_n = 0;
  double exponent = 1;
  double bend_per_count = 0;
  double squares = std::numeric_limits<double>::infinity();  ///< of the relative errors

  /// Logarithm of the load at `to` over that at `from`, a smaller reading; above zero.
  [[nodiscard]] double rise(double from, double to) const {
    const double line = std::log(to / from);
    return std::max(exponent * line + bend_per_count * (to - from), 0.1 * line);
  }
};

class ShapeFit {
 public:
  ShapeFit(const std::vector<double>& forces_n, const std::vector<double>& readings)
      : forces_n_(forces_n), readings_(readings) {}

  [[nodiscard]] Shape at(double dead_zone_n, bool bends) const {
    NormalEquations equations(bends ? 3 : 2);
    for (std::size_t i = 0; i < forces_n_.size(); ++i) {
      // Relative to the first reading and force, which keeps the sums small.
      const std::array row = {1.0, std::log(readings_[i] / readings_[0]),
                              readings_[i] / readings_.back()};
      equations.add(std::span(row).first(equations.unknowns()),
                    std::log((forces_n_[i] - dead_zone_n) / forces_n_[0]));
    }
    const auto fitted = equations.solve(std::vector<bool>(equations.unknowns(), true));
    if (!fitted) return {};
    const double bend = bends ? (*fitted)[2] / readings_.back() : 0;
    return {dead_zone_n, (*fitted)[1], bend, equations.squares_at(*fitted)};
  }

  [[nodiscard]] Shape best(bool bends) const {
    const auto squares = [&](double zone_n) { return at(zone_n, bends).squares; };
    const Shape with =
        at(least_of(squares, 0, kMostDeadZone * forces_n_[0], 1e-6 * forces_n_[0]), bends);
    const Shape without = at(0, bends);
    return with.squares < without.squares ? with : without;
  }

 private:
  const std::vector<double>& forces_n_;
  const std::vector<double>& readings_;
};

Shape fit_shape(const std::vector<double>& forces_n, const std::vector<double>& readings) {
  const ShapeFit fit(forces_n, readings);
  if (forces_n.size() < kLeastForDeadZone) return fit.at(0, false);
  const Shape power_law = fit.best(false);
  // Four forces do not determine a dead zone beside the three numbers of a bent curve.
  const Shape bent = forces_n.size() > kLeastForDeadZone ? fit.best(true) : fit.at(0, true);
  const double good = kGoodFit * kGoodFit * static_cast<double>(forces_n.size());
  return bent.squares < kBentWins * (power_law.squares - good) ? bent : power_law;
}

/// Adds a knot at `factor` times the reading of `knot`, on the power law through it and `other`.
void continue_curve(ResponseCurve& curve, std::size_t knot, std::size_t other, double factor,
                    std::size_t place) {
  const double exponent = std::log(curve.loads[other] / curve.loads[knot]) /
                          std::log(curve.readings[other] / curve.readings[knot]);
  const auto offset = static_cast<std::ptrdiff_t>(place);
  const double reading = factor * curve.readings[knot];
  const double load = std::pow(factor, exponent) * curve.loads[knot];
  curve.readings.insert(curve.readings.begin() + offset, reading);
  curve.loads.insert(curve.loads.begin() + offset, load);
}

/// Continues the power law through the nearest two knots to two knots below and one beyond.
void continue_power_law(ResponseCurve& curve) {
  const std::size_t last = curve.readings.size() - 1;
  continue_curve(curve, last, last - 1, 1.5, last + 1);
  continue_curve(curve, 0, 1, 1.0 / 4, 0);
  continue_curve(curve, 0, 1, 1.0 / 4, 0);
}

/// Adds the same knots along a bent curve, and one between any two, from both.
ResponseCurve follow(const Shape& shape, const ResponseCurve& curve) {
  ResponseCurve all;
  const auto add = [&](double reading, double log_load) {
    all.readings.push_back(reading);
    all.loads.push_back(std::exp(log_load));
  };
  const std::vector<double>& readings = curve.readings;
  const double first = readings.front();
  for (const double below : {first / 16, first / 4}) {
    add(below, std::log(curve.loads.front()) - shape.rise(below, first));
  }
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const double load = std::log(curve.loads[i]);
    add(readings[i], load);
    if (i + 1 == readings.size() || readings.size() > kMostRefined) continue;
    const double middle = std::sqrt(readings[i] * readings[i + 1]);
    const double next = std::log(curve.loads[i + 1]);
    const double between =
        (load + next + shape.rise(readings[i], middle) - shape.rise(middle, readings[i + 1])) / 2;
    if (between > load && between < next) add(middle, between);
  }
  add(1.5 * readings.back(),
      std::log(curve.loads.back()) + shape.rise(readings.back(), 1.5 * readings.back()));
  return all;
}

}  // namespace

CommonResponse fit_common_response(const std::vector<double>& forces_n,
                                   const std::vector<double>& readings) {
  const Shape shape = fit_shape(forces_n, readings);
  CommonResponse response;
  response.dead_zone_n = shape.dead_zone_n;
  ResponseCurve& curve = response.curve;
  curve.readings = readings;
  for (const double force_n : forces_n) curve.loads.push_back(force_n - response.dead_zone_n);
  if (shape.bend_per_count != 0) {
    curve = follow(shape, curve);
  } else {
    continue_power_law(curve);
  }
  return response;
}

}  // namespace pillarfield
