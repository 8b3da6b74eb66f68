#include "pillarfield/skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/pitch.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/surface.h"

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

TEST(Skin, APitchIsOneNumberOrThatOfRowsAndThatOfColumns) {
  EXPECT_EQ(parse_pitch("5"), Pitch(5));
  EXPECT_EQ(parse_pitch("7.62x5.08"), Pitch(7.62, 5.08));
  EXPECT_EQ(text_of({7.62, 5.08}), "7.62x5.08");
  EXPECT_EQ(text_of(5), "5");
  for (const char* const text : {"", "x", "5x", "x5", "5x5x5", "5 x 5", "0", "5x0", "1e4", "nan"}) {
    EXPECT_FALSE(parse_pitch(text)) << text;
  }
  Skin skin = good_skin();
  skin.layout = SkinLayout::sensels;
  skin.sensel_pitch_mm = {7.62, 5.08};
  EXPECT_NO_THROW(check(skin, "skin"));
  EXPECT_EQ(kpa_per_newton(skin.element_pitch_mm()), static_cast<float>(1000 / (7.62 * 5.08)));
  const std::vector<Pose> poses = poses_of({}, skin.element_grid());
  EXPECT_NEAR(poses[1].position_mm.x - poses[0].position_mm.x, 5.08, 1e-12);
  EXPECT_NEAR(poses[0].position_mm.y - poses[skin.cols].position_mm.y, 7.62, 1e-12);
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
      {"sensel_pitch_mm",
       [](Skin& s) {
         s.sensel_pitch_mm = {1, 2000};
       }},
      {"a pitch of 1x2 mm, and pillars",
       [](Skin& s) {
         s.sensel_pitch_mm = {1, 2};
       }},
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

}  // namespace
}  // namespace pillarfield
