#include "calibration/response_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <span>
#include <utility>

#include "calibration/golden_section.h"
#include "calibration/normal_equations.h"
#include "skin/pillar_sensels.h"

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

namespace {

/// Least signal-to-noise ratio of a sensel that responds.
constexpr double kLeastSignalToNoise = 4;

constexpr double kNewtonsPerKpaMm2 = 1e-3;

std::vector<double> levels_of(std::span<const UniformPress> presses) {
  std::set<double> pressures;
  for (const UniformPress& press : presses) pressures.insert(press.pressure_kpa);
  return {pressures.begin(), pressures.end()};
}

}  // namespace

/// Weighted sums over the presses to which a sensel responds: force n, response y, weight w.
struct ResponseFit::Sums {
  double w = 0;
  double n = 0;
  double y = 0;
  double nn = 0;
  double ny = 0;
  double yy = 0;
  double least_n = 0;
  double most_n = 0;
  std::size_t presses = 0;
  std::size_t saturated = 0;

  void add(double force_n, double response, double weight) {
    least_n = presses == 0 ? force_n : std::min(least_n, force_n);
    most_n = presses == 0 ? force_n : std::max(most_n, force_n);
    ++presses;
    w += weight;
    n += weight * force_n;
    y += weight * response;
    nn += weight * force_n * force_n;
    ny += weight * force_n * response;
    yy += weight * response * response;
  }
};

ResponseFit::ResponseFit(std::span<const UniformPress> presses, const Calibration& planes)
    : presses_(presses.begin(), presses.end()), planes_(planes), levels_(levels_of(presses)) {}

double ResponseFit::force_n(const UniformPress& press, std::size_t sensel) const {
  const Skin& skin = press.frames.skin();
  const double area_mm2 = skin.element_pitch_mm().area_mm2();
  return press.pressure_kpa * area_mm2 * kNewtonsPerKpaMm2 *
         linear_sum(planes_.effects, skin, sensel);
}

std::optional<double> ResponseFit::response(const UniformPress& press, std::size_t sensel) const {
  const SenselStatistics& pressed = press.frames.sensels()[sensel];
  if (pressed.saturated > 0 || 2 * pressed.readings <= press.frames.frames()) return std::nullopt;
  const double noise = planes_.noise.empty() ? pressed.deviation() : planes_.noise[sensel];
  const double response = pressed.mean - planes_.tare[sensel];
  return response > kLeastSignalToNoise * noise ? std::optional(response) : std::nullopt;
}

void ResponseFit::straighten(CommonResponse common, double force_n, double reading) {
  common_ = std::move(common);
  newtons_per_reading_ = force_n / reading;
}

/// The force under which a straight line would read what the sensel reads.
double ResponseFit::fitted_force_n(const UniformPress& press, std::size_t sensel) const {
  const double force = force_n(press, sensel);
  if (!common_) return force;
  return newtons_per_reading_ * reading_at(common_->curve, force - common_->dead_zone_n);
}

double ResponseFit::force_at(const Response& fitted, double response) const {
  const double force = response * fitted.newtons_per_count;
  return common_ ? common_->force_at(force / newtons_per_reading_) : force + fitted.dead_zone_n;
}

Response ResponseFit::operator()(std::size_t sensel) const {
  Sums sums;
  for (const UniformPress& press : presses_) {
    if (press.frames.sensels()[sensel].saturated > 0) {
      ++sums.saturated;
    } else if (const auto responded = response(press, sensel)) {
      sums.add(fitted_force_n(press, sensel), *responded, press.frames.sensels()[sensel].readings);
    }
  }
  if (sums.saturated == presses_.size()) return {.kind = Response::Kind::saturated};
  if (sums.presses == 0) return {.kind = Response::Kind::unresponsive};
  if (levels_.size() == 1 && !common_) return ratio(sums, sensel);
  if (sums.most_n > sums.least_n) return line(sums);
  return {.kind = sums.saturated > 0 ? Response::Kind::saturated : Response::Kind::one_level};
}

/// One pressure: k n − z = gain · y with the given dead zone z.
Response ResponseFit::ratio(const Sums& sums, std::size_t sensel) const {
  const double mean_response = sums.y / sums.w;
  const double dead_zone = planes_.dead_zone.empty() ? 0 : planes_.dead_zone[sensel];
  return {.kind = Response::Kind::good,
          .newtons_per_count = sums.n / sums.w / mean_response,
          .dead_zone_gain = sensel_sum(planes_.effects, presses_.front().frames.skin(), sensel) *
                            dead_zone / mean_response};
}

/// Several pressures: least squares of y = s (n − n0) under n0 >= 0, or n0 = 0 for multiples of the
/// common response.
Response ResponseFit::line(const Sums& sums) const {
  const double mean_n = sums.n / sums.w;
  double slope = (sums.ny - sums.n * sums.y / sums.w) / (sums.nn - sums.n * mean_n);
  if (slope <= 0) return {.kind = Response::Kind::unresponsive};
  double start_n = mean_n - sums.y / sums.w / slope;
  if (start_n < 0 || common_) {
    slope = sums.ny / sums.nn;
    start_n = 0;
  }
  // Sum of (y − s n + s n0)².
  const double rest = sums.yy + slope * slope * (sums.nn - 2 * start_n * sums.n) +
                      slope * start_n * (slope * start_n * sums.w + 2 * sums.y) -
                      2 * slope * sums.ny;
  return {.kind = Response::Kind::good,
          .newtons_per_count = 1 / slope,
          .dead_zone_n = common_ ? common_->dead_zone_n : start_n,
          .misfit = std::max(0.0, rest),
          .responded = sums.yy};
}

namespace {

/// The response of a sensel to each press; false where one of them has none.
bool all_responses(const ResponseFit& fit, std::size_t sensel, std::vector<double>& responses) {
  for (std::size_t press = 0; press < responses.size(); ++press) {
    const auto response = fit.response(fit.presses()[press], sensel);
    if (!response) return false;
    responses[press] = *response;
  }
  return true;
}

/// Sums over the sensels that respond to every press.
struct RespondingSensels {
  std::vector<double> responses;  ///< one for each press
  double linear = 0;
  std::size_t count = 0;
};

/// Unset where half of the good sensels or fewer respond.
std::optional<RespondingSensels> responding_sensels(const ResponseFit& fit,
                                                    const std::vector<std::uint8_t>& mask) {
  const Skin& skin = fit.presses().front().frames.skin();
  RespondingSensels sums{std::vector<double>(fit.presses().size())};
  std::vector<double> responses(fit.presses().size());
  std::size_t good = 0;
  for_each_solved_sensel(skin, [&](std::size_t i) {
    if (!mask.empty() && mask[i] != kGood) return;
    ++good;
    if (!all_responses(fit, i, responses)) return;
    ++sums.count;
    sums.linear += linear_sum(fit.planes().effects, skin, i);
    for (std::size_t p = 0; p < responses.size(); ++p) sums.responses[p] += responses[p];
  });
  return 2 * sums.count > good ? std::optional(sums) : std::nullopt;
}

}  // namespace

std::optional<LevelReadings> level_readings(const ResponseFit& fit,
                                            const std::vector<std::uint8_t>& mask) {
  const std::vector<UniformPress>& presses = fit.presses();
  const Skin& skin = presses.front().frames.skin();
  const auto responding = responding_sensels(fit, mask);
  if (!responding) return std::nullopt;
  LevelReadings at;
  for (const double level : fit.levels()) {
    double sum = 0;
    double frames = 0;
    for (std::size_t p = 0; p < presses.size(); ++p) {
      if (presses[p].pressure_kpa != level) continue;
      sum += responding->responses[p] * presses[p].frames.frames();
      frames += presses[p].frames.frames();
    }
    const double area_mm2 = skin.element_pitch_mm().area_mm2();
    const auto count = static_cast<double>(responding->count);
    at.readings.push_back(sum / frames / count);
    at.forces_n.push_back(level * area_mm2 * kNewtonsPerKpaMm2 * responding->linear / count);
  }
  const bool increase = std::ranges::is_sorted(at.readings, std::less_equal<>());
  return increase ? std::optional(at) : std::nullopt;
}

}  // namespace pillarfield
