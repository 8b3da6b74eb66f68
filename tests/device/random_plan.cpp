#include "random_plan.h"

#include <cmath>
#include <limits>

namespace pillarfield {
namespace {

using Random = std::mt19937;

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

double random_reading(Random& random, double largest) {
  const double kind = uniform(random, 0, 1);
  if (kind < 0.33) return 0;
  return kind < 0.36 ? largest : uniform(random, 0, largest);
}

float random_float_reading(Random& random, double largest) {
  const double kind = uniform(random, 0, 1);
  if (kind < 0.02) return std::numeric_limits<float>::quiet_NaN();
  if (kind < 0.04) return std::numeric_limits<float>::infinity();
  if (kind < 0.06) return -std::numeric_limits<float>::infinity();
  if (kind < 0.10) return static_cast<float>(uniform(random, -10, 0));
  if (kind < 0.12) return std::numeric_limits<float>::denorm_min();
  return static_cast<float>(random_reading(random, largest));
}

template <class Value>
std::vector<Value> random_plane(Random& random, std::size_t size, double low, double high) {
  std::vector<Value> plane(size);
  for (Value& value : plane) value = static_cast<Value>(uniform(random, low, high));
  return plane;
}

/// Scales the noise to the same mean for all sizes and seeds. It is a constant of the program,
/// which is thus compiled once.
void set_mean_noise(Calibration& calibration) {
  double squares = 0;
  double count = 0;
  for (std::size_t i = 0; i < calibration.noise.size(); ++i) {
    if (calibration.mask[i] != kGood) continue;
    squares += double{calibration.noise[i]} * calibration.noise[i];
    ++count;
  }
  const double scale = 1.8 / std::sqrt(squares / count);
  for (float& noise : calibration.noise) noise = static_cast<float>(scale * noise);
}

}  // namespace

RandomFrame::RandomFrame(const SolverPlan& plan, std::size_t padding, std::uint32_t seed)
    : skin_(plan.skin), type_(plan.sensel_type), row_stride_(plan.skin.cols + padding) {
  Random random(seed);
  // No reading more than the frame has, so that a sanitizer detects reads beyond it.
  const std::size_t size = (skin_.rows - 1) * row_stride_ + skin_.cols;
  for (std::size_t i = 0; i < size; ++i) {
    switch (type_) {
      case SenselType::u8:
        u8_.push_back(static_cast<std::uint8_t>(random_reading(random, 255)));
        break;
      case SenselType::u16:
        u16_.push_back(static_cast<std::uint16_t>(random_reading(random, 4095)));
        break;
      case SenselType::f32:
        f32_.push_back(random_float_reading(random, 300));
        break;
    }
  }
}

FrameView RandomFrame::view() const {
  const void* data = f32_.data();
  if (type_ == SenselType::u8) data = u8_.data();
  if (type_ == SenselType::u16) data = u16_.data();
  return {data, type_, skin_.rows, skin_.cols, row_stride_};
}

SolverPlan bare_plan(std::uint32_t rows, std::uint32_t cols, SenselType type) {
  SolverPlan plan;
  plan.skin.rows = rows;
  plan.skin.cols = cols;
  plan.sensel_type = type;
  plan.estimator = Estimator::direct;
  return plan;
}

SolverPlan full_plan(std::uint32_t rows, std::uint32_t cols, SenselType type, std::uint32_t seed) {
  Random random(seed);
  SolverPlan plan = bare_plan(rows, cols, type);
  plan.skin.threshold_counts = 2.5;
  plan.skin.counts_per_newton = 317;
  plan.skin.full_scale_counts = type == SenselType::u16 ? 4000 : 250;
  plan.parity_tolerance_counts = 30;
  plan.segment_point = 0.7;
  const std::size_t size = plan.skin.sensels();
  plan.calibration.tare = random_plane<float>(random, size, -3, 6);
  plan.calibration.gain = random_plane<float>(random, size, 0.8, 1.25);
  plan.calibration.dead_zone = random_plane<float>(random, size, 0, 4);
  plan.calibration.noise = random_plane<float>(random, size, 0.2, 3);
  for (const float share : random_plane<float>(random, size, 0, 1)) {
    plan.calibration.mask.push_back(share < 0.85F ? kGood : share < 0.9F ? kAbsent : kMissing);
  }
  set_mean_noise(plan.calibration);
  return plan;
}

}  // namespace pillarfield
