#include "lab/studies/bound.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include "pillarfield/host_solve.h"
#include "pillarfield/status.h"

namespace pillarfield::bound {
namespace {

using Row = std::array<double, 3>;

/// Coefficients of the force's components in the readings of sensels 1 to 4, for k = 1 (M3).
constexpr double kCos45 = std::numbers::sqrt2 / 2;
constexpr std::array<Row, 4> kModel = {{
    {kCos45, kCos45, 1},
    {-kCos45, kCos45, 1},
    {-kCos45, -kCos45, 1},
    {kCos45, -kCos45, 1},
}};

constexpr std::uint32_t kPillarsOfRow = 100;  ///< of the frame that is solved

/// Trace of the inverse of a symmetric matrix: the sum of its principal minors over its
/// determinant.
double trace_of_inverse(const std::array<Row, 3>& m) {
  const auto minor_of = [&](std::size_t i, std::size_t j) {
    return m[i][i] * m[j][j] - m[i][j] * m[i][j];
  };
  const double determinant = m[0][0] * minor_of(1, 2) -
                             m[0][1] * (m[0][1] * m[2][2] - m[1][2] * m[0][2]) +
                             m[0][2] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]);
  return (minor_of(0, 1) + minor_of(1, 2) + minor_of(0, 2)) / determinant;
}

/// A frame of pillars that all have V `v`, each with other noise.
FrameBuffer noisy_frame(const std::array<double, 4>& v, const SolverPlan& plan,
                        std::uint64_t number) {
  FrameBuffer frame(SenselType::f32, plan.skin.rows, plan.skin.cols);
  const auto readings = frame.readings<float>();
  std::mt19937_64 engine(number);
  std::normal_distribution<double> noise(0, plan.noise_counts.value_or(0));
  for (std::size_t pillar = 0; pillar < plan.skin.pillars(); ++pillar) {
    for (std::size_t n = 0; n < 4; ++n) {
      readings[place_of(pillar, n, kPillarsOfRow)] =
          static_cast<float>(std::max(0.0, v[n]) + noise(engine));
    }
  }
  return frame;
}

SolverPlan plan_of(const PillarSensor& sensor, Estimator estimator, int draws) {
  SolverPlan plan;
  plan.skin.cols = 2 * kPillarsOfRow;
  plan.skin.rows = 2 * static_cast<std::uint32_t>(draws) / kPillarsOfRow;
  plan.skin.counts_per_newton = sensor.counts_per_newton;
  plan.skin.threshold_counts = sensor.threshold_counts;
  plan.sensel_type = SenselType::f32;
  plan.noise_counts = sensor.noise_counts;
  plan.estimator = estimator;
  return plan;
}

}  // namespace

std::array<double, 4> model_readings(Force force, double counts_per_newton) {
  std::array<double, 4> v{};
  for (std::size_t n = 0; n < 4; ++n) {
    v[n] = counts_per_newton * (kModel[n][0] * force.shear_x + kModel[n][1] * force.shear_y +
                                kModel[n][2] * force.normal);
  }
  return v;
}

std::size_t place_of(std::size_t pillar, std::size_t sensel, std::size_t pillar_cols) {
  const std::size_t row = 2 * (pillar / pillar_cols) + sensel / 2;
  const bool is_right = sensel == 0 || sensel == 3;
  return 2 * (row * pillar_cols + pillar % pillar_cols) + (is_right ? 1 : 0);
}

std::uint8_t bits_above(const std::array<double, 4>& v, double counts) {
  unsigned bits = 0;
  for (std::size_t n = 0; n < 4; ++n) bits |= v[n] > counts ? 1U << n : 0U;
  return static_cast<std::uint8_t>(bits);
}

Force force_from(double magnitude_n, double theta_rad, double phi_rad) {
  const double shear = magnitude_n * std::sin(theta_rad);
  return {-shear * std::cos(phi_rad), -shear * std::sin(phi_rad),
          magnitude_n * std::cos(theta_rad)};
}

double information(double deviations) {
  constexpr double kAllOfIt = 30;  // beyond, the probability of inactivity underflows
  if (deviations > kAllOfIt) return 1;
  const double density = std::exp(-deviations * deviations / 2) / std::sqrt(2 * std::numbers::pi);
  const double inactive = std::erfc(deviations / std::numbers::sqrt2) / 2;
  const double speaks = std::erfc(-deviations / std::numbers::sqrt2) / 2;
  return speaks - deviations * density + density * density / inactive;
}

double least_error(Force force, const PillarSensor& sensor) {
  const std::array<double, 4> v = model_readings(force, sensor.counts_per_newton);
  std::array<Row, 3> sum{};
  for (std::size_t n = 0; n < 4; ++n) {
    if (v[n] <= 0) continue;  // V below zero carries no information.
    const double weight = information((v[n] - sensor.threshold_counts) / sensor.noise_counts);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += weight * kModel[n][i] * kModel[n][j];
    }
  }
  return sensor.noise_counts / sensor.counts_per_newton * std::sqrt(trace_of_inverse(sum));
}

bool is_far_from_borders(Force force, const PillarSensor& sensor, double deviations) {
  const double least = deviations * sensor.noise_counts;
  return std::ranges::all_of(model_readings(force, sensor.counts_per_newton), [&](double each) {
    return std::abs(each - sensor.threshold_counts) >= least;
  });
}

int usable_sensels(Force force, const PillarSensor& sensor) {
  return std::popcount(
      bits_above(model_readings(force, sensor.counts_per_newton), sensor.threshold_counts));
}

RmsError rms_error(Force force, const PillarSensor& sensor, Estimator estimator, int draws,
                   std::uint64_t number) {
  const std::array<double, 4> v = model_readings(force, sensor.counts_per_newton);
  const std::uint8_t expected = bits_above(v, sensor.threshold_counts);
  const SolverPlan plan = plan_of(sensor, estimator, draws);
  const ForceField solved = solve_on_host(plan, noisy_frame(v, plan, number).view());
  double sum = 0;
  double sum_of_rightly_read = 0;
  int rightly_read = 0;
  for (std::size_t i = 0; i < solved.elements(); ++i) {
    const double x = double{solved.shear_x[i]} - force.shear_x;
    const double y = double{solved.shear_y[i]} - force.shear_y;
    const double z = double{solved.normal[i]} - force.normal;
    const double squared = x * x + y * y + z * z;
    sum += squared;
    if ((solved.status[i] & status::kUsable) != expected) continue;
    sum_of_rightly_read += squared;
    ++rightly_read;
  }
  return {std::sqrt(sum / draws), std::sqrt(sum_of_rightly_read / std::max(rightly_read, 1)),
          1 - static_cast<double>(rightly_read) / draws};
}

}  // namespace pillarfield::bound
