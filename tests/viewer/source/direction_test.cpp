#include "viewer/source/direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace pillarfield::viewer {
namespace {

TEST(Direction, ComesFromWhereThePaperPutsIt) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 10000; ++i) {
    const double magnitude = std::pow(10, 12 * share(random) - 8);
    const double theta = share(random) * std::numbers::pi / 2;
    const double phi = (2 * share(random) - 1) * std::numbers::pi;
    const auto x = static_cast<float>(-magnitude * std::sin(theta) * std::cos(phi));
    const auto y = static_cast<float>(-magnitude * std::sin(theta) * std::sin(phi));
    const auto normal = static_cast<float>(magnitude * std::cos(theta));
    const Direction direction = direction_of(x, y, normal);
    EXPECT_NEAR(direction.magnitude / magnitude, 1, 3e-7);
    EXPECT_NEAR(direction.theta, theta, 1e-6);
    const double turn = std::remainder(direction.phi - phi, 2 * std::numbers::pi);
    EXPECT_NEAR(turn * std::sin(theta), 0, 1e-6);
  }
}

TEST(Direction, ZerosOfEitherSignAreTheSame) {
  for (const float x : {0.0F, -0.0F}) {
    for (const float y : {0.0F, -0.0F}) {
      for (const float normal : {0.0F, -0.0F}) {
        const Direction none = direction_of(x, y, normal);
        EXPECT_EQ(none.magnitude, 0);
        EXPECT_EQ(none.theta, 0);
        EXPECT_EQ(none.phi, 0);
      }
      EXPECT_EQ(direction_of(x, y, 1).phi, 0);
    }
    EXPECT_EQ(direction_of(1, x, 0).phi, std::numbers::pi_v<float>) << "not minus pi";
  }
}

}  // namespace
}  // namespace pillarfield::viewer
