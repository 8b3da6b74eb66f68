#include "calibration/response_fit.h"

#include <algorithm>
#include <set>
#include <utility>

#include "calibration/leak_sum.h"
#include "skin/pillar_sensels.h"

namespace pillarfield {
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
  const double area_mm2 = skin.pillar_pitch_mm() * skin.pillar_pitch_mm();
  return press.pressure_kpa * area_mm2 * kNewtonsPerKpaMm2 *
         leak_sum(planes_.effects, skin, sensel);
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
  return {
      .kind = Response::Kind::good,
      .newtons_per_count = sums.n / sums.w / mean_response,
      .dead_zone_gain = sensel_leak_sum(planes_.effects, presses_.front().frames.skin(), sensel) *
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
  double leaks = 0;
  std::size_t count = 0;
};

/// Unset where half of the good sensels or fewer respond.
std::optional<RespondingSensels> responding_sensels(const ResponseFit& fit,
                                                    const std::vector<std::uint8_t>& mask) {
  const Skin& skin = fit.presses().front().frames.skin();
  RespondingSensels sums{std::vector<double>(fit.presses().size())};
  std::vector<double> responses(fit.presses().size());
  std::size_t good = 0;
  for_each_pillar(skin, [&](auto, auto, const auto& sensels) {
    for (const std::size_t i : sensels) {
      if (!mask.empty() && mask[i] != kGood) continue;
      ++good;
      if (!all_responses(fit, i, responses)) continue;
      ++sums.count;
      sums.leaks += leak_sum(fit.planes().effects, skin, i);
      for (std::size_t p = 0; p < responses.size(); ++p) sums.responses[p] += responses[p];
    }
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
    const double area_mm2 = skin.pillar_pitch_mm() * skin.pillar_pitch_mm();
    const auto count = static_cast<double>(responding->count);
    at.readings.push_back(sum / frames / count);
    at.forces_n.push_back(level * area_mm2 * kNewtonsPerKpaMm2 * responding->leaks / count);
  }
  const bool increase = std::ranges::is_sorted(at.readings, std::less_equal<>());
  return increase ? std::optional(at) : std::nullopt;
}

}  // namespace pillarfield
