// Perceptual properties of the colour tables.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "colour_science.h"
#include "viewer/style/colour_map.h"

namespace pillarfield::viewer {
namespace {

std::vector<Lab> seen_table(ColourMap map, Sight sight = Sight::normal) {
  std::vector<Lab> labs;
  for (const Colour& colour : table_of(map)) labs.push_back(seen(colour, sight));
  return labs;
}

/// Differences between entries `stride` apart; over smaller strides rounding to bytes dominates.
std::vector<double> steps(const std::vector<Lab>& labs, std::size_t stride, bool closed) {
  std::vector<double> steps;
  const std::size_t last = closed ? labs.size() : labs.size() - stride;
  for (std::size_t i = 0; i < last; ++i) {
    steps.push_back(difference(labs[i], labs[(i + stride) % labs.size()]));
  }
  return steps;
}

double unevenness(const std::vector<double>& steps) {
  const auto [least, most] = std::minmax_element(steps.begin(), steps.end());
  return *most / *least;
}

TEST(SequentialTables, BeginAndEndAsPublished) {
  const auto cividis = table_of(ColourMap::cividis);
  EXPECT_EQ(cividis[0], colour_from(0x00224e));
  EXPECT_EQ(cividis[128], colour_from(0x7d7c78));
  EXPECT_EQ(cividis[255], colour_from(0xfee838));
  const auto viridis = table_of(ColourMap::viridis);
  EXPECT_EQ(viridis[0], colour_from(0x440154));
  EXPECT_EQ(viridis[128], colour_from(0x21918c));
  EXPECT_EQ(viridis[255], colour_from(0xfde725));
}

TEST(SequentialTables, GrowLighterForEveryEye) {
  for (const ColourMap map : {ColourMap::cividis, ColourMap::viridis}) {
    for (const Sight sight : kSights) {
      const std::vector<Lab> labs = seen_table(map, sight);
      for (std::size_t i = 4; i < labs.size(); ++i) {
        EXPECT_GT(labs[i].lightness, labs[i - 4].lightness)
            << name_of(map) << " at " << i << ", sight " << static_cast<int>(sight);
      }
    }
  }
}

TEST(SequentialTables, GrowByEvenSteps) {
  EXPECT_LT(unevenness(steps(seen_table(ColourMap::cividis), 8, false)), 2.6);
  EXPECT_LT(unevenness(steps(seen_table(ColourMap::viridis), 8, false)), 2.1);
}

TEST(DivergingTable, IsSymmetricInLightnessAboutANeutralMiddle) {
  const std::vector<Lab> labs = seen_table(ColourMap::diverging);
  for (std::size_t i = 0; i < 128; ++i) {
    EXPECT_NEAR(labs[i].lightness, labs[255 - i].lightness, 0.4) << i;
  }
  for (const std::size_t middle : {std::size_t{127}, std::size_t{128}}) {
    EXPECT_LT(std::hypot(labs[middle].a, labs[middle].b), 1.5);
  }
}

TEST(DivergingTable, DarkensByEqualStepsFromTheMiddle) {
  const std::vector<Lab> labs = seen_table(ColourMap::diverging);
  const double step = (labs[127].lightness - labs[0].lightness) / 127;
  EXPECT_GT(step, 0.25);
  for (std::size_t i = 0; i < 128; ++i) {
    const double expected = labs[0].lightness + step * static_cast<double>(i);
    EXPECT_NEAR(labs[i].lightness, expected, 0.4) << i;
    EXPECT_NEAR(labs[255 - i].lightness, expected, 0.4) << i;
  }
  EXPECT_LT(unevenness(steps(labs, 8, false)), 2);
}

TEST(DivergingTable, IsBlueBelowAndOrangeAbove) {
  const std::vector<Lab> labs = seen_table(ColourMap::diverging);
  EXPECT_LT(labs.front().b, -40);
  EXPECT_GT(labs.back().b, 40);
  EXPECT_GT(labs.back().a, 20);
}

TEST(DivergingTable, KeepsItsSidesApartForEveryEye) {
  for (const Sight sight : kSights) {
    const std::vector<Lab> labs = seen_table(ColourMap::diverging, sight);
    // The two sides differ clearly a quarter of the way out, and increasingly beyond.
    for (std::size_t i = 0; i < 128 - 32; ++i) {
      EXPECT_GT(difference(labs[i], labs[255 - i]), 14) << i << " " << static_cast<int>(sight);
    }
    EXPECT_GT(difference(labs.front(), labs.back()), 40);
    EXPECT_GT(difference(labs.front(), labs[128]), 30);
    EXPECT_GT(difference(labs.back(), labs[127]), 30);
  }
}

TEST(CyclicTable, ClosesAndGoesByEvenSteps) {
  const std::vector<Lab> labs = seen_table(ColourMap::cyclic);
  EXPECT_LT(difference(labs.front(), labs.back()), 1);
  EXPECT_LT(unevenness(steps(labs, 4, true)), 2);
}

TEST(CyclicTable, HasAboutOneLightness) {
  for (const Lab& lab : seen_table(ColourMap::cyclic)) {
    EXPECT_GT(lab.lightness, 46);
    EXPECT_LT(lab.lightness, 82);
    EXPECT_GT(std::hypot(lab.a, lab.b), 20) << "no grey on the way";
  }
}

TEST(CyclicTable, HasFourQuadrantsForEveryEye) {
  for (const Sight sight : kSights) {
    const std::vector<Lab> labs = seen_table(ColourMap::cyclic, sight);
    for (std::size_t i = 0; i < 256; ++i) {
      EXPECT_GT(difference(labs[i], labs[(i + 64) % 256]), 10)
          << i << " " << static_cast<int>(sight);
      EXPECT_GT(difference(labs[i], labs[(i + 128) % 256]), 20)
          << i << " " << static_cast<int>(sight);
    }
  }
}

TEST(CyclicTable, SeparatesUpByLightnessAndRightByYellow) {
  const std::vector<Lab> labs = seen_table(ColourMap::cyclic);
  EXPECT_GT(labs[192].lightness, labs[64].lightness + 30);
  EXPECT_GT(labs[128].b, labs[0].b + 70);
}

}  // namespace
}  // namespace pillarfield::viewer
