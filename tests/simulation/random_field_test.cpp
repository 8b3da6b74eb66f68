#include "simulation/body/random_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace pillarfield {
namespace {

constexpr double kSpacingMm = 0.1;

RandomField rough(double exponent) {
  return RandomField::self_affine({7, random::Stream::roughness, 0}, kSpacingMm, 20, exponent);
}

/// Mean square of what the field differs by over a distance.
double structure(const RandomField& field, double distance_mm) {
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const double x = i * 0.25;
      const double y = j * 0.25;
      const double difference = field.at(x + distance_mm, y) - field.at(x, y);
      sum += difference * difference;
    }
  }
  return sum / 4e4;
}

TEST(RandomField, RoughnessHasItsRootMeanSquareAndItsExponent) {
  double squares = 0;
  const RandomField field = rough(0.5);
  for (int i = 0; i < 512; ++i) {
    for (int j = 0; j < 512; ++j) squares += std::pow(field.at(i * kSpacingMm, j * kSpacingMm), 2);
  }
  EXPECT_NEAR(squares / (512.0 * 512), 1, 1e-9);
  // Self-affine between the shortest and the longest wave: differences grow as distance^(2H).
  const auto growth = [](const RandomField& of) {
    return std::log2(structure(of, 3) / structure(of, 1.5));
  };
  EXPECT_NEAR(growth(field), 1, 0.25);
  EXPECT_GT(growth(rough(0.9)), growth(field) + 0.2);
}

TEST(RandomField, ASmoothFieldIsBetweenItsBoundsAndSmooth) {
  const RandomField field = RandomField::smooth({7, random::Stream::friction, 3}, 5);
  double most = 0;
  double squares = 0;
  double steepest = 0;
  for (int i = 0; i < 512; ++i) {
    for (int j = 0; j < 512; ++j) {
      const double value = field.at(i * 0.625, j * 0.625);
      most = std::max(most, std::abs(value));
      squares += value * value;
      steepest = std::max(steepest, std::abs(field.at(i * 0.625 + 0.1, j * 0.625) - value) / 0.1);
    }
  }
  EXPECT_LE(most, 1);
  EXPECT_GT(most, 0.999);
  EXPECT_NEAR(squares / (512.0 * 512), 1.0 / 3, 0.03);
  EXPECT_LT(steepest, 1);
}

TEST(RandomField, RepeatsAndDiffersByWhatItIsFor) {
  const RandomField field = rough(0.8);
  EXPECT_NEAR(field.at(1.23, -4.5), field.at(1.23 + 51.2, -4.5 - 51.2), 1e-9);
  const RandomField other =
      RandomField::self_affine({7, random::Stream::roughness, 1}, kSpacingMm, 20, 0.8);
  EXPECT_NE(field.at(1, 1), other.at(1, 1));
}

}  // namespace
}  // namespace pillarfield
