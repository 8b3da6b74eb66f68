#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/host_solve.h"

/// Readings of ideal pillars, for tests of corrections.
namespace pillarfield {

inline constexpr double kPressedCountsPerNewton = 100;

/// V of the sensels of ideal pillars under the forces, [rows, cols], counts; zero where they lift.
inline std::vector<double> loads_of(const ForceField& forces, const ShearCoefficient& c = {}) {
  std::vector<double> v(4 * forces.normal.size());
  for (std::size_t i = 0; i < forces.normal.size(); ++i) {
    const double x = c.x * forces.shear_x[i] / std::numbers::sqrt2;
    const double y = c.y * forces.shear_y[i] / std::numbers::sqrt2;
    const double normal = forces.normal[i];
    const std::size_t cols = 2 * std::size_t{forces.cols};
    const std::size_t at = i / forces.cols * 2 * cols + i % forces.cols * 2;
    const std::array<double, 4> newtons = {normal - x + y, normal + x + y, normal - x - y,
                                           normal + x - y};
    for (std::size_t n = 0; n < 4; ++n) {
      v[at + n / 2 * cols + n % 2] = std::max(0.0, kPressedCountsPerNewton * newtons[n]);
    }
  }
  return v;
}

/// A patch of random forces in the middle of a skin, all in region 1.
inline ForceField random_patch(std::uint32_t rows, std::uint32_t cols, unsigned seed) {
  ForceField forces(rows, cols);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> part(-0.5F, 0.5F);
  for (std::uint32_t row = 3; row + 3 < rows; ++row) {
    for (std::uint32_t col = 3; col + 3 < cols; ++col) {
      const std::size_t i = std::size_t{row} * cols + col;
      forces.normal[i] = 1 + part(random);
      forces.shear_x[i] = forces.normal[i] * part(random);
      forces.shear_y[i] = forces.normal[i] * part(random);
    }
  }
  return forces;
}

inline SolverPlan pressed_plan(std::uint32_t pillar_rows, std::uint32_t pillar_cols,
                               const SensorEffects& effects) {
  SolverPlan plan;
  plan.skin.rows = 2 * pillar_rows;
  plan.skin.cols = 2 * pillar_cols;
  plan.skin.counts_per_newton = kPressedCountsPerNewton;
  plan.skin.threshold_counts = 0.5;
  plan.sensel_type = SenselType::f32;
  plan.estimator = Estimator::direct;
  plan.calibration.effects = effects;
  return plan;
}

inline ForceField solve_readings(const SolverPlan& plan, std::span<const double> readings) {
  const std::vector<float> frame(readings.begin(), readings.end());
  return solve_on_host(
      plan, {frame.data(), SenselType::f32, plan.skin.rows, plan.skin.cols, plan.skin.cols});
}

/// The largest error of a component, counts.
inline double largest_error(const ForceField& solved, const ForceField& truth) {
  double largest = 0;
  for (std::size_t i = 0; i < truth.normal.size(); ++i) {
    largest = std::max({largest, std::abs(double{solved.shear_x[i]} - truth.shear_x[i]),
                        std::abs(double{solved.shear_y[i]} - truth.shear_y[i]),
                        std::abs(double{solved.normal[i]} - truth.normal[i])});
  }
  return kPressedCountsPerNewton * largest;
}

/// Pillars in contact.
inline std::size_t pressed_count(const ForceField& forces) {
  return static_cast<std::size_t>(
      std::ranges::count_if(forces.normal, [](float normal) { return normal > 0; }));
}

}  // namespace pillarfield
