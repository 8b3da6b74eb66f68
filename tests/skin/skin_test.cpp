#include "pillarfield/skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

Skin good_skin() {
  Skin skin;
  skin.rows = 10;
  skin.cols = 20;
  return skin;
}

TEST(Skin, CountsPillars) {
  Skin skin = good_skin();
  EXPECT_NO_THROW(check(skin, "skin"));
  EXPECT_EQ(skin.pillars(), 50U);
  skin.rows = 11;
  EXPECT_EQ(skin.pillar_rows(), 5U);
  EXPECT_EQ(skin.sensels(), 220U);
  EXPECT_NEAR(1 / (skin.pillar_pitch_mm() * skin.pillar_pitch_mm()), 0.625, 1e-9);
}

TEST(Skin, RefusesValuesOutOfRangeByName) {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    const char* name;
    std::function<void(Skin&)> spoil;
  };
  const std::vector<Case> cases = {
      {"rows", [](Skin& s) { s.rows = 1; }},
      {"rows", [](Skin& s) { s.rows = 65535; }},
      {"cols", [](Skin& s) { s.cols = 0; }},
      {"sensel_pitch_mm", [](Skin& s) { s.sensel_pitch_mm = 0; }},
      {"sensel_pitch_mm", [](Skin& s) { s.sensel_pitch_mm = kNan; }},
      {"counts_per_newton", [](Skin& s) { s.counts_per_newton = -1; }},
      {"counts_per_newton", [](Skin& s) { s.counts_per_newton = INFINITY; }},
      {"threshold_counts", [](Skin& s) { s.threshold_counts = -0.5; }},
      {"full_scale_counts", [](Skin& s) { s.full_scale_counts = kNan; }},
      {"power_law_exponent",
       [](Skin& s) {
         s.power_law = {0.1, 100};
       }},
      {"power_law_exponent",
       [](Skin& s) {
         s.power_law = {kNan, 100};
       }},
      {"power_law_reference_counts",
       [](Skin& s) {
         s.power_law = {1.2, 0};
       }},
      {"full_scale_counts", [](Skin& s) { s.full_scale_counts = s.threshold_counts; }},
  };
  for (const Case& wrong : cases) {
    Skin skin = good_skin();
    wrong.spoil(skin);
    try {
      check(skin, "the skin");
      FAIL() << wrong.name << " passed";
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find(std::string("the skin: ") + wrong.name), 0U)
          << error.what();
    }
  }
}

TEST(Skin, SenselTypesHaveSizesAndNames) {
  EXPECT_EQ(size_of(SenselType::u8), 1U);
  EXPECT_EQ(size_of(SenselType::u16), 2U);
  EXPECT_EQ(size_of(SenselType::f32), 4U);
  EXPECT_STREQ(name_of(SenselType::u8), "uint8");
  EXPECT_STREQ(name_of(SenselType::u16), "uint16");
  EXPECT_STREQ(name_of(SenselType::f32), "float32");
}

TEST(Error, IsOneLineOfThreeParts) {
  EXPECT_STREQ(Error("a.toml:3", "key 'x' is\nunknown", "allowed: y").what(),
               "a.toml:3: key 'x' is unknown; allowed: y");
  EXPECT_STREQ(Error("", "it failed").what(), "it failed");
}

}  // namespace
}  // namespace pillarfield
