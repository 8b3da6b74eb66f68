#include "calibration/response_fit.h"

#include <algorithm>
#include <set>

namespace pillarfield {
namespace {

/// Least signal-to-noise ratio of a sensel that responds.
constexpr double kLeastSignalToNoise = 4;

constexpr double kNewtonsPerKpaMm2 = 1e-3;

std::size_t count_levels(std::span<const UniformPress> presses) {
  std::set<double> pressures;
  for (const UniformPress& press : presses) pressures.insert(press.pressure_kpa);
  return pressures.size();
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
    : presses_(presses),
      planes_(planes),
      area_mm2_(presses.front().frames.skin().pillar_pitch_mm() *
                presses.front().frames.skin().pillar_pitch_mm()),
      levels_(count_levels(presses)) {}

double ResponseFit::response(const SenselStatistics& pressed, std::size_t sensel) const {
  return pressed.mean - planes_.tare[sensel];
}

bool ResponseFit::responds(const SenselStatistics& pressed, std::size_t sensel) const {
  const double noise = planes_.noise.empty() ? pressed.deviation() : planes_.noise[sensel];
  return response(pressed, sensel) > kLeastSignalToNoise * noise;
}

Response ResponseFit::operator()(std::size_t sensel) const {
  Sums sums;
  for (const UniformPress& press : presses_) {
    const SenselStatistics& pressed = press.frames.sensels()[sensel];
    if (pressed.saturated > 0) {
      ++sums.saturated;
    } else if (2 * pressed.readings > press.frames.frames() && responds(pressed, sensel)) {
      sums.add(press.pressure_kpa * area_mm2_ * kNewtonsPerKpaMm2, response(pressed, sensel),
               pressed.readings);
    }
  }
  if (sums.saturated == presses_.size()) return {.kind = Response::Kind::saturated};
  if (sums.presses == 0) return {.kind = Response::Kind::unresponsive};
  if (levels_ == 1) return ratio(sums, sensel);
  if (sums.most_n > sums.least_n) return line(sums);
  return {.kind = sums.saturated > 0 ? Response::Kind::saturated : Response::Kind::one_level};
}

/// One pressure: k n − z = gain · y with the given dead zone z.
Response ResponseFit::ratio(const Sums& sums, std::size_t sensel) const {
  const double mean_response = sums.y / sums.w;
  const double dead_zone = planes_.dead_zone.empty() ? 0 : planes_.dead_zone[sensel];
  return {.kind = Response::Kind::good,
          .newtons_per_count = sums.n / sums.w / mean_response,
          .dead_zone_gain = dead_zone / mean_response};
}

/// Several pressures: least squares of y = s (n − n0) under n0 >= 0.
Response ResponseFit::line(const Sums& sums) {
  const double mean_n = sums.n / sums.w;
  double slope = (sums.ny - sums.n * sums.y / sums.w) / (sums.nn - sums.n * mean_n);
  if (slope <= 0) return {.kind = Response::Kind::unresponsive};
  double start_n = mean_n - sums.y / sums.w / slope;
  if (start_n < 0) {
    slope = sums.ny / sums.nn;
    start_n = 0;
  }
  // Sum of (y − s n + s n0)².
  const double rest = sums.yy + slope * slope * (sums.nn - 2 * start_n * sums.n) +
                      slope * start_n * (slope * start_n * sums.w + 2 * sums.y) -
                      2 * slope * sums.ny;
  return {.kind = Response::Kind::good,
          .newtons_per_count = 1 / slope,
          .dead_zone_n = start_n,
          .misfit = std::max(0.0, rest),
          .responded = sums.yy};
}

}  // namespace pillarfield
