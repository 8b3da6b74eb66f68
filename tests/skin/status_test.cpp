#include "pillarfield/status.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <set>

#include "simulation/ideal_readings.h"

namespace pillarfield {
namespace {

using double_precision::Force;

TEST(Status, RegionFollowsTheNumberAndPlaceOfUsableReadings) {
  for (int bits = 0; bits < 16; ++bits) {
    const auto status = static_cast<std::uint8_t>(bits);
    const bool opposite = bits == (status::kSensel1 | status::kSensel3) ||
                          bits == (status::kSensel2 | status::kSensel4);
    constexpr Region kByCount[] = {Region::none, Region::four, Region::three, Region::two,
                                   Region::one};
    const Region expected = opposite ? Region::opposite : kByCount[std::popcount(status)];
    EXPECT_EQ(region_of(status), expected) << bits;
    EXPECT_EQ(region_of(static_cast<std::uint8_t>(status | 0xF0)), expected) << bits;
  }
}

TEST(Status, ForcesAreDeterminedOrOnASegmentOrNeither) {
  for (int bits = 0; bits < 256; ++bits) {
    const auto status = static_cast<std::uint8_t>(bits);
    const Region region = region_of(status);
    const bool saturated = (bits & status::kSaturated) != 0;
    const bool spoilt = saturated || (bits & status::kInconsistent) != 0;
    EXPECT_EQ(is_determined(status), (region == Region::one || region == Region::two) && !saturated)
        << bits;
    EXPECT_EQ(has_feasible_segment(status),
              region == Region::three && (bits & status::kAmbiguous) != 0 && !spoilt)
        << bits;
  }
}

TEST(Status, EveryRegionHasAName) {
  std::set<std::string> names;
  for (int i = 0; i < kRegions; ++i) names.insert(name_of(static_cast<Region>(i)));
  EXPECT_EQ(names, (std::set<std::string>{"none", "1", "2", "3", "4", "opposite"}));
  EXPECT_STREQ(name_of(Region::none), "none");
  EXPECT_STREQ(name_of(Region::three), "3");
}

Force force_from(double theta, double phi) {
  return {double{static_cast<float>(-std::sin(theta) * std::cos(phi))},
          double{static_cast<float>(-std::sin(theta) * std::sin(phi))},
          double{static_cast<float>(std::cos(theta))}};
}

TEST(IdealReadings, AForceOnABoundaryHasTheFewerReadings) {
  using std::numbers::pi;
  // Along a diagonal in the plane one sensel reads, along an axis two adjacent ones.
  EXPECT_EQ(usable_bits(ideal_readings(force_from(pi / 2, pi / 4), 1)), status::kSensel3);
  EXPECT_EQ(usable_bits(ideal_readings(force_from(pi / 2, 3 * pi / 4), 1)), status::kSensel4);
  EXPECT_EQ(usable_bits(ideal_readings(force_from(pi / 2, 0), 1)),
            status::kSensel2 | status::kSensel3);
  // At 45 degrees along a diagonal one reading just vanishes.
  EXPECT_EQ(usable_bits(ideal_readings(force_from(pi / 4, pi / 4), 1)),
            status::kUsable & ~status::kSensel1);
  EXPECT_EQ(usable_bits(ideal_readings({0, 0, 0}, 1)), 0);
  EXPECT_EQ(usable_bits(ideal_readings({0, 0, -1}, 1)), 0);
  EXPECT_EQ(usable_bits(ideal_readings({0, 0, 1e-30}, 1)), status::kUsable);
}

}  // namespace
}  // namespace pillarfield
