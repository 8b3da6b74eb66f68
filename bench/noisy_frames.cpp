#include "bench/noisy_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "base/random.h"
#include "bench/solve_variant.h"

namespace pillarfield::bench {
namespace {

using double_precision::Force;

constexpr std::uint64_t kSeed = 23;
constexpr std::size_t kForces = std::size_t{1} << 16;  ///< before they repeat
constexpr double kLeastCounts = 15;
constexpr double kMostCounts = 150;

/// Forces in counts.
std::vector<Force> draw_forces() {
  std::vector<Force> forces;
  std::array<double, 4> shares{};
  for (std::uint64_t i = 0; i < kForces; ++i) {
    random::fill_uniform({kSeed, random::Stream::probe, i, 0}, shares);
    const double magnitude = kLeastCounts * std::pow(kMostCounts / kLeastCounts, shares[0]);
    const double cosine = shares[1];
    const double shear = magnitude * std::sqrt(1 - cosine * cosine);
    const double phi = 2 * std::numbers::pi * shares[2];
    forces.push_back({-shear * std::cos(phi), -shear * std::sin(phi), magnitude * cosine});
  }
  return forces;
}

const std::vector<Force>& forces() {
  static const std::vector<Force> all = draw_forces();
  return all;
}

/// Index of the force on a row's first pillar; each row takes a piece of forces().
std::size_t piece_of(std::size_t frame, std::uint32_t row) {
  std::array<double, 1> share{};
  random::fill_uniform({kSeed, random::Stream::positioner, frame, row}, share);
  return static_cast<std::size_t>(share[0] * static_cast<double>(kForces));
}

template <class Reading>
Reading converted(double counts) {
  if constexpr (std::numeric_limits<Reading>::is_integer) {
    constexpr double kMost = std::numeric_limits<Reading>::max();
    return static_cast<Reading>(std::lround(std::clamp(counts, 0.0, kMost)));
  }
  return static_cast<Reading>(counts);
}

/// Readings of a plan's sensels under forces().
class Sensor {
 public:
  explicit Sensor(const SolverPlan& plan) : skin_(plan.skin), calibration_(plan.calibration) {
    const double scale = count_scale(plan.sensel_type);
    noise_counts_ = kSensorNoiseCounts * scale;
    for (const Force& force : forces()) {
      readings_.push_back(double_precision::model_readings(force, scale));
    }
  }

  template <class Reading>
  void read(std::size_t frame, Reading* readings) const {
    std::vector<float> noise(skin_.cols);
    for (std::uint32_t row = 0; row < skin_.rows; ++row) {
      random::fill_normal({kSeed, random::Stream::noise, frame, row}, noise);
      const std::size_t piece = piece_of(frame, row / 2);
      for (std::uint32_t col = 0; col < skin_.cols; ++col) {
        const auto& v = readings_[(piece + col / 2) % kForces];
        const double model = row % 2 == 0 ? (col % 2 == 0 ? v.v2 : v.v1)  // top left, top right
                                          : (col % 2 == 0 ? v.v3 : v.v4);
        const std::size_t sensel = std::size_t{row} * skin_.cols + col;
        readings[sensel] = converted<Reading>(raw(sensel, model, noise_counts_ * noise[col]));
      }
    }
  }

 private:
  [[nodiscard]] double raw(std::size_t sensel, double model, double noise) const {
    const auto value = [&](const std::vector<float>& plane, double otherwise) {
      return plane.empty() ? otherwise : plane[sensel];
    };
    if (!is_good(calibration_, sensel)) return 0;
    const double response = std::max(0.0, model - value(calibration_.dead_zone, 0));
    return value(calibration_.tare, 0) + response / value(calibration_.gain, 1) + noise;
  }

  Skin skin_;
  const Calibration& calibration_;
  double noise_counts_ = 0;
  std::vector<double_precision::Readings> readings_;  ///< V of all forces, counts of the type
};

std::vector<FrameBuffer> read_frames(const SolverPlan& plan, std::size_t count) {
  const Sensor sensor(plan);
  std::vector<FrameBuffer> frames;
  for (std::size_t i = 0; i < count; ++i) {
    FrameBuffer& frame = frames.emplace_back(plan.sensel_type, plan.skin.rows, plan.skin.cols);
    switch (plan.sensel_type) {
      case SenselType::u8:
        sensor.read(i, frame.readings<std::uint8_t>().data());
        break;
      case SenselType::u16:
        sensor.read(i, frame.readings<std::uint16_t>().data());
        break;
      case SenselType::f32:
        sensor.read(i, frame.readings<float>().data());
        break;
    }
  }
  return frames;
}

}  // namespace

NoisyFrames::NoisyFrames(const SolverPlan& plan, std::size_t count)
    : frames_(plan.skin, read_frames(plan, count)),
      counts_per_newton_(plan.skin.counts_per_newton),
      count_scale_(count_scale(plan.sensel_type)) {}

Force NoisyFrames::truth(std::size_t frame, std::uint32_t row, std::uint32_t col) const {
  const Force& counts = forces()[(piece_of(frame, row) + col) % kForces];
  const double newtons = count_scale_ / counts_per_newton_;
  return {newtons * counts.shear_x, newtons * counts.shear_y, newtons * counts.normal};
}

}  // namespace pillarfield::bench
