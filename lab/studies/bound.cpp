#include "lab/studies/bound.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "base/random.h"
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

std::array<double, 4> readings_of(Force force, const PillarSensor& sensor) {
  const auto v = double_precision::model_readings(force, sensor.counts_per_newton);
  return {v.v1, v.v2, v.v3, v.v4};
}

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

int usable_bits(const std::array<double, 4>& v, const Sensels& sensels) {
  int bits = 0;
  for (std::size_t n = 0; n < 4; ++n) bits |= v[n] > sensels[n].threshold_counts ? 1 << n : 0;
  return bits;
}

Sensels all_alike(const PillarSensor& sensor) { return {sensor, sensor, sensor, sensor}; }

/// Readings of one pillar, again and again, each time with other noise.
class NoisyReadings {
 public:
  NoisyReadings(const std::array<double, 4>& v, double noise_counts, std::uint64_t number)
      : v_(v), noise_counts_(noise_counts), number_(number), noise_(4 * kBlock) {}

  [[nodiscard]] std::array<double, 4> next() {
    const std::size_t at = drawn_++ % kBlock;
    if (at == 0) draw_block();
    std::array<double, 4> raw{};
    for (std::size_t n = 0; n < 4; ++n) {
      raw[n] = std::max(0.0, v_[n]) + noise_counts_ * noise_[4 * at + n];
    }
    return raw;
  }

 private:
  static constexpr std::size_t kBlock = 1 << 14;
  static constexpr std::uint64_t kSeed = 20;

  void draw_block() {
    const auto block = static_cast<std::uint32_t>(drawn_ / kBlock);
    random::fill_normal({kSeed, random::Stream::noise, number_, block}, noise_);
  }

  std::array<double, 4> v_;
  double noise_counts_;
  std::uint64_t number_;
  std::size_t drawn_ = 0;
  std::vector<float> noise_;
};

double squared_error(const Force& estimate, const Force& truth) {
  const double x = estimate.shear_x - truth.shear_x;
  const double y = estimate.shear_y - truth.shear_y;
  const double z = estimate.normal - truth.normal;
  return x * x + y * y + z * z;
}

}  // namespace

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
  return least_error(force, all_alike(sensor));
}

double least_error(Force force, const Sensels& sensels) {
  const double unit = sensels[0].noise_counts;  // So that no weight is far from 1.
  const std::array<double, 4> v = readings_of(force, sensels[0]);
  std::array<Row, 3> sum{};
  for (std::size_t n = 0; n < 4; ++n) {
    if (v[n] <= 0) continue;  // V below zero carries no information.
    const double noise = sensels[n].noise_counts;
    const double share = information((v[n] - sensels[n].threshold_counts) / noise);
    const double weight = share * (unit / noise) * (unit / noise);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) sum[i][j] += weight * kModel[n][i] * kModel[n][j];
    }
  }
  return unit / sensels[0].counts_per_newton * std::sqrt(trace_of_inverse(sum));
}

bool is_far_from_borders(Force force, const PillarSensor& sensor, double deviations) {
  return is_far_from_borders(force, all_alike(sensor), deviations);
}

bool is_far_from_borders(Force force, const Sensels& sensels, double deviations) {
  const std::array<double, 4> v = readings_of(force, sensels[0]);
  for (std::size_t n = 0; n < 4; ++n) {
    const double distance = std::abs(v[n] - sensels[n].threshold_counts);
    if (!(distance >= deviations * sensels[n].noise_counts)) return false;
  }
  return true;
}

int usable_sensels(Force force, const PillarSensor& sensor) {
  return usable_sensels(force, all_alike(sensor));
}

int usable_sensels(Force force, const Sensels& sensels) {
  const int bits = usable_bits(readings_of(force, sensels[0]), sensels);
  return std::popcount(static_cast<unsigned>(bits));
}

RmsError rms_error(Force force, const PillarSensor& sensor, Estimator estimator, int draws,
                   std::uint64_t number) {
  const std::array<double, 4> v = readings_of(force, sensor);
  const int expected = usable_bits(v, all_alike(sensor));
  NoisyReadings noisy(v, sensor.noise_counts, number);
  double sum = 0;
  double sum_of_rightly_read = 0;
  int rightly_read = 0;
  for (int draw = 0; draw < draws; ++draw) {
    const auto estimate = estimate_pillar(noisy.next(), sensor, estimator);
    const double squared = squared_error(estimate.force, force);
    sum += squared;
    if ((estimate.status & status::kUsable) != expected) continue;
    sum_of_rightly_read += squared;
    ++rightly_read;
  }
  return {std::sqrt(sum / draws), std::sqrt(sum_of_rightly_read / std::max(rightly_read, 1)),
          1 - static_cast<double>(rightly_read) / draws};
}

}  // namespace pillarfield::bound
