#include "pillarfield/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

void set(ForceField& field, std::size_t i, double x, double y, double normal) {
  field.shear_x[i] = static_cast<float>(x);
  field.shear_y[i] = static_cast<float>(y);
  field.normal[i] = static_cast<float>(normal);
}

/// The region by counting the positive readings of equation (2).
struct NaiveRegion {
  std::uint8_t usable = 0;
  int count = 0;
};

NaiveRegion naive_region(double x, double y, double normal) {
  const double theta = std::atan2(std::hypot(x, y), normal);
  const double phi = std::atan2(-y, -x);
  NaiveRegion region;
  for (int n = 1; n <= 4; ++n) {
    const double v =
        std::cos(theta) - std::sin(theta) * std::cos(std::numbers::pi / 4 * (2 * n - 1) - phi);
    if (std::hypot(x, y, normal) == 0 || v <= 1e-6) continue;
    region.usable |= static_cast<std::uint8_t>(1 << (n - 1));
    ++region.count;
  }
  return region;
}

struct Frames {
  ForceField truth{50, 60};
  ForceField solved{50, 60};
};

/// Forces of all directions, a fifth of the pillars without, errors over six decades, and one
/// status in ten wrong.
Frames random_frames(std::uint64_t seed) {
  Frames frames;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < frames.truth.elements(); ++i) {
    const double magnitude = unit(random) < 0.2 ? 0 : 0.1 + unit(random);
    const double theta = std::acos(unit(random));
    const double phi = 2 * std::numbers::pi * unit(random);
    const double x = magnitude * std::sin(theta) * std::cos(phi);
    const double y = magnitude * std::sin(theta) * std::sin(phi);
    const double z = magnitude * std::cos(theta);
    const double error = std::pow(10.0, -6 * unit(random));
    set(frames.truth, i, x, y, z);
    set(frames.solved, i, x + error * normal(random), y + error * normal(random),
        z + error * normal(random));
    frames.solved.status[i] = naive_region(x, y, z).usable;
    if (unit(random) < 0.1) frames.solved.status[i] ^= 4;
    frames.solved.status[i] |= 64;
  }
  return frames;
}

double root_mean_square(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double percentile_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(0.95 * static_cast<double>(values.size()))) - 1];
}

/// All errors of one region, one by one.
struct NaiveErrors {
  std::vector<double> error;
  std::vector<double> relative;
  std::vector<double> theta_error;
  std::vector<double> phi_error;
  std::uint64_t mismatches = 0;

  void add(const Frames& frames, std::size_t i) {
    const auto at = [&](const ForceField& f) {
      return std::array{double{f.shear_x[i]}, double{f.shear_y[i]}, double{f.normal[i]}};
    };
    const auto [tx, ty, tz] = at(frames.truth);
    const auto [sx, sy, sz] = at(frames.solved);
    const double length = std::sqrt(tx * tx + ty * ty + tz * tz);
    const double theta = std::acos(tz / length);
    error.push_back(std::sqrt(std::pow(sx - tx, 2) + std::pow(sy - ty, 2) + std::pow(sz - tz, 2)));
    relative.push_back(error.back() / length);
    theta_error.push_back(std::acos(sz / std::sqrt(sx * sx + sy * sy + sz * sz)) - theta);
    const double turn = std::arg(std::polar(1.0, std::atan2(sy, sx) - std::atan2(ty, tx)));
    phi_error.push_back(std::sin(theta) * turn);
    mismatches += (frames.solved.status[i] & 15) != naive_region(tx, ty, tz).usable ? 1U : 0U;
  }
};

void expect_errors(const RegionErrors& is, const NaiveErrors& expected) {
  ASSERT_FALSE(expected.error.empty());
  EXPECT_EQ(is.pillars, expected.error.size());
  EXPECT_EQ(is.status_mismatches, expected.mismatches);
  EXPECT_NEAR(is.rms_n, root_mean_square(expected.error), 1e-9);
  EXPECT_NEAR(is.rms_relative, root_mean_square(expected.relative), 1e-9);
  EXPECT_NEAR(is.theta_rms_rad, root_mean_square(expected.theta_error), 1e-6);
  EXPECT_NEAR(is.phi_rms_rad, root_mean_square(expected.phi_error), 1e-6);
  EXPECT_GE(is.p95_n, percentile_95(expected.error) * (1 - 1e-9));
  EXPECT_LE(is.p95_n, percentile_95(expected.error) * 1.0201);
  EXPECT_GE(is.p95_relative, percentile_95(expected.relative) * (1 - 1e-9));
  EXPECT_LE(is.p95_relative, percentile_95(expected.relative) * 1.0201);
}

TEST(Comparison, AgreesWithANaiveComputation) {
  Comparison comparison;
  NaiveErrors by_count[5];
  NaiveErrors loaded;
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const Frames frames = random_frames(seed);
    comparison.add(frames.solved.view(), frames.truth.view());
    for (std::size_t i = 0; i < frames.truth.elements(); ++i) {
      const int count =
          naive_region(double{frames.truth.shear_x[i]}, double{frames.truth.shear_y[i]},
                       double{frames.truth.normal[i]})
              .count;
      if (count == 0) continue;
      by_count[count].add(frames, i);
      loaded.add(frames, i);
    }
  }
  expect_errors(comparison.region(Region::one), by_count[4]);
  expect_errors(comparison.region(Region::two), by_count[3]);
  expect_errors(comparison.region(Region::three), by_count[2]);
  expect_errors(comparison.loaded(), loaded);
  EXPECT_EQ(comparison.region(Region::opposite).pillars, 0U);
  EXPECT_EQ(comparison.region(Region::none).pillars, 9000U - loaded.error.size());
}

TEST(Comparison, NothingAddedIsNoError) {
  const RegionErrors errors = Comparison().loaded();
  EXPECT_EQ(errors.pillars, 0U);
  EXPECT_EQ(errors.rms_n, 0);
  EXPECT_EQ(errors.p95_n, 0);
}

TEST(Comparison, PhiIsComparedAroundTheCircle) {
  ForceField truth(1, 1);
  ForceField solved(1, 1);
  set(truth, 0, 1, 0.01, 1);
  set(solved, 0, 1, -0.01, 1);
  Comparison comparison;
  comparison.add(solved.view(), truth.view());
  EXPECT_NEAR(comparison.loaded().phi_rms_rad, 0.02 / std::sqrt(2), 1e-4);
}

TEST(Comparison, AGhostForceCountsInRegionNoneWithoutAngles) {
  ForceField truth(1, 2);
  ForceField solved(1, 2);
  set(solved, 1, 0.3, 0, 0.4);
  solved.status[1] = 15;
  Comparison comparison;
  comparison.add(solved.view(), truth.view());
  const RegionErrors none = comparison.region(Region::none);
  EXPECT_EQ(none.pillars, 2U);
  EXPECT_EQ(none.status_mismatches, 1U);
  EXPECT_NEAR(none.rms_n, 0.5 / std::sqrt(2), 1e-7);
  EXPECT_EQ(none.rms_relative, 0);
  EXPECT_EQ(none.theta_rms_rad, 0);
  EXPECT_EQ(comparison.loaded().pillars, 0U);
}

TEST(Comparison, ASolvedForceThatIsNoNumberIsAnInfiniteError) {
  ForceField truth(10, 10);
  for (std::size_t i = 0; i < 100; ++i) set(truth, i, 0, 0, 1);
  for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
    ForceField solved = truth;
    std::fill(solved.status.begin(), solved.status.end(), std::uint8_t{15});
    solved.shear_y[17] = bad;
    Comparison comparison;
    comparison.add(solved.view(), truth.view());
    const RegionErrors errors = comparison.loaded();
    EXPECT_EQ(errors.rms_n, kInfinite);
    EXPECT_EQ(errors.rms_relative, kInfinite);
    EXPECT_EQ(errors.p95_n, 0);  // 99 of 100 are exact
    EXPECT_EQ(errors.status_mismatches, 1U);
    EXPECT_TRUE(std::isfinite(errors.theta_rms_rad));
    EXPECT_GT(errors.theta_rms_rad, 0.3);
    for (std::size_t i = 0; i < 6; ++i) solved.normal[i] = bad;
    comparison.add(solved.view(), truth.view());
    comparison.add(solved.view(), truth.view());
    EXPECT_EQ(comparison.loaded().p95_n, 0);
    for (std::size_t i = 0; i < 60; ++i) solved.normal[i] = bad;
    comparison.add(solved.view(), truth.view());
    EXPECT_EQ(comparison.loaded().p95_n, kInfinite);
  }
}

TEST(Comparison, RefusesFieldsThatDoNotFit) {
  const ForceField truth(3, 4);
  const ForceField other(4, 3);
  Comparison comparison;
  EXPECT_THROW(comparison.add(other.view(), truth.view()), Error);
  ForceFieldView bare = truth.view();
  bare.status = {};
  EXPECT_THROW(comparison.add(bare, truth.view()), Error);
  bare = truth.view();
  bare.shear_x = {};
  EXPECT_THROW(comparison.add(truth.view(), bare), Error);
  ForceField damaged(3, 4);
  damaged.normal[5] = std::nanf("");
  EXPECT_THROW(comparison.add(truth.view(), damaged.view()), Error);
  EXPECT_EQ(comparison.region(Region::none).pillars, 0U);
}

}  // namespace
}  // namespace pillarfield
