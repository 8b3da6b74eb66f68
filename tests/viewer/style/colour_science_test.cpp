#include "colour_science.h"

#include <gtest/gtest.h>

namespace pillarfield::viewer {
namespace {

struct KnownDifference {
  Lab first, second;
  double difference;
};

// From the test data of Sharma, Wu and Dalal (2005): hues around blue and across the hue cut,
// greys, large and small differences.
constexpr KnownDifference kKnown[] = {
    {{50, 2.6772, -79.7751}, {50, 0, -82.7485}, 2.0425},
    {{50, 3.1571, -77.2803}, {50, 0, -82.7485}, 2.8615},
    {{50, 2.8361, -74.0200}, {50, 0, -82.7485}, 3.4412},
    {{50, -1.3802, -84.2814}, {50, 0, -82.7485}, 1.0000},
    {{50, -0.9009, -85.5211}, {50, 0, -82.7485}, 1.0000},
    {{50, 0, 0}, {50, -1, 2}, 2.3669},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0009}, 7.1792},
    {{50, 2.4900, -0.0010}, {50, -2.4900, 0.0011}, 7.2195},
    {{50, 2.5, 0}, {73, 25, -18}, 27.1492},
    {{50, 2.5, 0}, {61, -5, 29}, 22.8977},
    {{50, 2.5, 0}, {56, -27, -3}, 31.9030},
    {{50, 2.5, 0}, {58, 24, 15}, 19.4535},
    {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
    {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
};

TEST(ColourScience, DifferencesAreThePublishedOnes) {
  for (const auto& [first, second, expected] : kKnown) {
    EXPECT_NEAR(difference(first, second), expected, 5e-5) << expected;
    EXPECT_NEAR(difference(second, first), expected, 5e-5) << expected;
  }
}

TEST(ColourScience, LabOfKnownColours) {
  const auto expect_lab = [](std::uint32_t rgb, Lab expected) {
    const Lab lab = lab_of(colour_from(rgb));
    EXPECT_NEAR(lab.lightness, expected.lightness, 0.01) << rgb;
    EXPECT_NEAR(lab.a, expected.a, 0.02) << rgb;
    EXPECT_NEAR(lab.b, expected.b, 0.02) << rgb;
  };
  expect_lab(0xffffff, {100, 0, 0});
  expect_lab(0x000000, {0, 0, 0});
  expect_lab(0xff0000, {53.24, 80.09, 67.20});
  expect_lab(0x00ff00, {87.73, -86.18, 83.18});
  expect_lab(0x0000ff, {32.30, 79.19, -107.86});
  expect_lab(0x777777, {50.03, 0, 0});
}

TEST(ColourScience, GreysLookAlikeToAll) {
  for (const Sight sight : kSights) {
    for (const std::uint32_t grey : {0x000000U, 0x404040U, 0xc0c0c0U, 0xffffffU}) {
      EXPECT_LT(difference(seen(colour_from(grey), sight), lab_of(colour_from(grey))), 0.01);
    }
  }
}

TEST(ColourScience, RedAndGreenOfOneLightnessAreCloseToTheRedGreenBlind) {
  const Colour red = colour_from(0xc04040);
  const Colour green = colour_from(0x607f20);
  EXPECT_GT(difference(red, green), 40);
  EXPECT_LT(difference(red, green, Sight::deuteranopia), 20);
  EXPECT_GT(difference(red, green, Sight::tritanopia), 40);
}

}  // namespace
}  // namespace pillarfield::viewer
