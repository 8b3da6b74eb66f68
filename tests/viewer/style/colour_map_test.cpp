#include "viewer/style/colour_map.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "colour_science.h"
#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

using status::kAmbiguous;
using status::kFromNeighbours;
using status::kInconsistent;
using status::kSaturated;
using status::kSensel1;
using status::kSensel2;
using status::kSensel3;
using status::kSensel4;
using status::kUsable;

constexpr Theme kThemes[] = {Theme::dark, Theme::light};

/// The sets of colours of one legend.
const std::vector<std::vector<Special>>& legends() {
  static const std::vector<std::vector<Special>> legends = {
      {Special::idle, Special::determined, Special::ambiguous, Special::from_contact,
       Special::saturated, Special::inconsistent, Special::no_reading},
      {Special::idle, Special::region_1, Special::region_2, Special::region_3, Special::region_4,
       Special::opposite, Special::saturated, Special::no_reading},
  };
  return legends;
}

bool is_quiet(Special special) {
  return special == Special::idle || special == Special::no_reading;
}

TEST(Specials, AreFarFromEveryMap) {
  for (int i = 0; i < kSpecials; ++i) {
    const auto special = static_cast<Special>(i);
    if (is_quiet(special)) continue;
    for (int map = 0; map < kColourMaps; ++map) {
      for (const Colour& colour : table_of(static_cast<ColourMap>(map))) {
        EXPECT_GE(difference(colour_of(special, Theme::dark), colour), 10)
            << name_of(special) << " in " << name_of(static_cast<ColourMap>(map));
      }
    }
  }
}

TEST(Specials, OfOneLegendAreDistinctForEveryEye) {
  for (const Theme theme : kThemes) {
    for (const auto& legend : legends()) {
      for (const Special first : legend) {
        for (const Special second : legend) {
          if (first >= second) continue;
          for (const Sight sight : kSights) {
            EXPECT_GE(difference(colour_of(first, theme), colour_of(second, theme), sight),
                      is_quiet(second)         ? 9
                      : sight == Sight::normal ? 18
                                               : 14)
                << name_of(first) << " and " << name_of(second) << ", sight "
                << static_cast<int>(sight);
          }
        }
      }
    }
  }
}

TEST(Specials, DependOnTheThemeWhereQuiet) {
  for (int i = 0; i < kSpecials; ++i) {
    const auto special = static_cast<Special>(i);
    EXPECT_EQ(colour_of(special, Theme::dark) == colour_of(special, Theme::light),
              !is_quiet(special));
  }
}

TEST(Specials, IdleSkinIsNeutralAndStandsOutALittle) {
  for (const Theme theme : kThemes) {
    const Lab idle = lab_of(colour_of(Special::idle, theme));
    const double apart = difference(colour_of(Special::idle, theme), background_of(theme));
    EXPECT_GT(apart, 3);
    EXPECT_LT(apart, 8);
    EXPECT_LT(std::hypot(idle.a, idle.b), 6);
    EXPECT_TRUE(theme == Theme::dark ? idle.lightness < 25 : idle.lightness > 85);
  }
}

TEST(Names, AreThereAndDiffer) {
  std::set<std::string> names;
  for (int i = 0; i < kSpecials; ++i) names.insert(name_of(static_cast<Special>(i)));
  EXPECT_EQ(names.size(), std::size_t{kSpecials});
  EXPECT_STREQ(name_of(Special::saturated), "saturated");
  EXPECT_STREQ(name_of(Special::determined), "determined");
  EXPECT_STREQ(name_of(ColourMap::cividis), "cividis");
  EXPECT_STREQ(name_of(ColourMap::cyclic), "cyclic");
}

TEST(DefaultMap, FollowsTheScale) {
  EXPECT_EQ(default_map(Scale::sequential), ColourMap::cividis);
  EXPECT_EQ(default_map(Scale::diverging), ColourMap::diverging);
  EXPECT_EQ(default_map(Scale::cyclic), ColourMap::cyclic);
  EXPECT_EQ(default_map(Scale::classes), ColourMap::cividis);
}

TEST(SpecialOf, MapsColourDeterminedAndAmbiguousPillarsOnly) {
  EXPECT_EQ(special_of(Quantity::normal, kUsable), std::nullopt);
  EXPECT_EQ(special_of(Quantity::shear_x, kSensel1 | kSensel2 | kAmbiguous), std::nullopt);
  EXPECT_EQ(special_of(Quantity::normal, 0), Special::idle);
  EXPECT_EQ(special_of(Quantity::normal, kUsable | kSaturated), Special::saturated);
  EXPECT_EQ(special_of(Quantity::normal, kUsable | kInconsistent), Special::inconsistent);
  EXPECT_EQ(special_of(Quantity::phi, kSensel1 | kInconsistent), Special::inconsistent);
  EXPECT_EQ(special_of(Quantity::phi, kInconsistent), Special::no_reading) << "unpressed";
  EXPECT_EQ(special_of(Quantity::phi, kSaturated | kInconsistent), Special::inconsistent);
}

TEST(SpecialOf, RegionAndStatusAreClasses) {
  EXPECT_EQ(special_of(Quantity::region, kUsable), Special::region_1);
  EXPECT_EQ(special_of(Quantity::region, kUsable | kInconsistent), Special::region_1);
  EXPECT_EQ(special_of(Quantity::region, kSensel1 | kSensel2 | kSensel4), Special::region_2);
  EXPECT_EQ(special_of(Quantity::region, kSensel1 | kSensel2 | kAmbiguous), Special::region_3);
  EXPECT_EQ(special_of(Quantity::region, kSensel4), Special::region_4);
  EXPECT_EQ(special_of(Quantity::region, kSensel1 | kSensel3), Special::opposite);
  EXPECT_EQ(special_of(Quantity::region, kSaturated), Special::saturated) << "nothing usable";
  EXPECT_EQ(special_of(Quantity::region, 0), Special::idle);
  EXPECT_EQ(special_of(Quantity::status, kUsable), Special::determined);
  EXPECT_EQ(special_of(Quantity::status, kSensel1 | kSensel2 | kAmbiguous), Special::ambiguous);
  EXPECT_EQ(special_of(Quantity::status, kSensel1 | kSensel2 | kFromNeighbours),
            Special::from_contact);
  EXPECT_EQ(special_of(Quantity::status, kUsable | kSaturated | kInconsistent),
            Special::inconsistent);
  EXPECT_EQ(special_of(Quantity::status, 0), Special::idle);
}

TEST(SpecialOf, IsThereForEveryPillarOfAClassQuantity) {
  for (int status = 0; status < 256; ++status) {
    EXPECT_TRUE(special_of(Quantity::region, static_cast<std::uint8_t>(status)));
    EXPECT_TRUE(special_of(Quantity::status, static_cast<std::uint8_t>(status)));
  }
}

TEST(EntryOf, SplitsTheRangeEvenlyAndClamps) {
  const Range range{-2, 2};
  for (int entry = 0; entry < 256; ++entry) {
    const float low = -2 + static_cast<float>(entry) / 64;
    const auto expected = static_cast<std::size_t>(entry);
    EXPECT_EQ(entry_of(low, range, Scale::diverging), expected);
    EXPECT_EQ(entry_of(low + 1.0F / 65, range, Scale::diverging), expected);
  }
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(entry_of(-3, range, Scale::diverging), 0U);
  EXPECT_EQ(entry_of(2, range, Scale::diverging), 255U);
  EXPECT_EQ(entry_of(kInfinity, range, Scale::diverging), 255U);
  EXPECT_EQ(entry_of(-kInfinity, range, Scale::diverging), 0U);
}

TEST(EntryOf, ZeroIsTheFirstEntryOfTheUpperHalfOfADivergingRange) {
  for (const float high : {0.1F, 1.0F, 2e-5F, 5e7F}) {
    EXPECT_EQ(entry_of(0, {-high, high}, Scale::diverging), 128U);
  }
}

TEST(EntryOf, WrapsAroundACycle) {
  constexpr float kPi = std::numbers::pi_v<float>;
  const Range range{-kPi, kPi};
  EXPECT_EQ(entry_of(0, range, Scale::cyclic), 128U);
  EXPECT_EQ(entry_of(-kPi, range, Scale::cyclic), 0U);
  EXPECT_EQ(entry_of(kPi, range, Scale::cyclic), 0U) << "the same direction";
  EXPECT_EQ(entry_of(kPi / 2, range, Scale::cyclic), 192U);
  for (int i = -40; i < 40; ++i) {
    const float angle = 0.05F + static_cast<float>(i) * 0.07F;
    EXPECT_EQ(entry_of(angle + 2 * kPi, range, Scale::cyclic),
              entry_of(angle, range, Scale::cyclic));
    EXPECT_EQ(entry_of(angle - 2 * kPi, range, Scale::cyclic),
              entry_of(angle, range, Scale::cyclic));
  }
}

TEST(EntryOf, IsAnEntryWhateverTheValue) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (const Scale scale : {Scale::sequential, Scale::diverging, Scale::cyclic, Scale::classes}) {
    EXPECT_EQ(entry_of(kNan, {0, 1}, scale), 0U);
    EXPECT_EQ(entry_of(0, {0, 0}, scale), 0U);
    for (const float value : {-kInfinity, -3e38F, -1.0F, 0.0F, 1.0F, 3e38F, kInfinity}) {
      EXPECT_LT(entry_of(value, {0, 1}, scale), kColours);
      EXPECT_LT(entry_of(value, {0, 1e-30F}, scale), kColours);
    }
  }
}

}  // namespace
}  // namespace pillarfield::viewer
