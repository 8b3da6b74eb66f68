#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

std::string scene_text(const std::string& indenter, const std::string& more = "") {
  return "skin.size_mm = [40, 40]\n[[indenter]]\n" + indenter + "\n" + more;
}

Scene parsed_scene(const std::string& text) { return parse_scene(text, "folder/s.toml"); }

/// Keys of no table of numbers.
TEST(IndenterOfAScene, EveryKeyIsRead) {
  const Scene scene = parsed_scene(
      "[skin]\nsize_mm = [40, 40]\nmodulus_kpa = 250\n"
      "[[indenter]]\nshape = \"height_map\"\nheight_map = \"maps/key.npy\"\n"
      "height_map_size_mm = [30, 10]\nheight_map_depth_mm = 2\nfriction = 0.9\nsubsteps = 4\n"
      "path = [{ time_s = 0, position_mm = [1, 2], load_n = 3 },\n"
      "  { time_s = 0.5, position_mm = [2, 3], angle_deg = 40, load_n = 5 }]\n"
      "[[indenter]]\nshape = \"ellipsoid\"\nradii_mm = [9, 8, 7]\nfriction = 0\n"
      "position_mm = [4, 5]\nangle_deg = 6\nload_n = 7\n");
  EXPECT_EQ(scene.modulus_kpa, 250);
  ASSERT_EQ(scene.indenters.size(), 2U);
  const Indenter& key = scene.indenters[0];
  EXPECT_EQ(key.height_map, "folder/maps/key.npy");
  EXPECT_EQ(key.height_map_size_mm[0], 30);
  EXPECT_EQ(key.height_map_size_mm[1], 10);
  EXPECT_EQ(key.substeps, 4U);
  ASSERT_EQ(key.path.size(), 2U);
  EXPECT_EQ(key.path[0].angle_deg, 0);
  EXPECT_EQ(key.path[1].time_s, 0.5);
  EXPECT_EQ(key.path[1].angle_deg, 40);
  EXPECT_EQ(key.path[1].load_n, 5);
  EXPECT_EQ(scene.indenters[1].radii_mm[2], 7);
  EXPECT_EQ(scene.indenters[1].path[0].angle_deg, 6);
}

/// Friction may be left out where nothing feels shear.
TEST(IndenterOfAScene, OnlyPillarsNeedFriction) {
  const std::string ball =
      "[[indenter]]\nshape = \"sphere\"\nradius_mm = 9\nposition_mm = [0, 0]\nload_n = 1\n";
  const std::string size = "[skin]\nsensels = [8, 8]\n";
  EXPECT_EQ(parsed_scene(ball + size + "layout = \"sensels\"").indenters[0].friction, 0);
  EXPECT_EQ(core_test::message_of([&] { static_cast<void>(parsed_scene(ball + size)); }),
            "folder/s.toml:1: key 'friction' in [[indenter]] is missing; allowed: a number in "
            "[0, 10]");
}

/// A scene is read without its height maps, a simulator is not made without them.
TEST(IndenterOfAScene, HeightMapsAreOpenedBySimulatorsAlone) {
  const Scene scene = parsed_scene(scene_text(
      "shape = \"height_map\"\nheight_map = \"/nowhere/key.npy\"\nheight_map_size_mm = [9, 9]\n"
      "height_map_depth_mm = 1\nfriction = 1\nposition_mm = [0, 0]\nload_n = 1"));
  EXPECT_EQ(scene.indenters[0].height_map, "/nowhere/key.npy");
  EXPECT_EQ(core_test::message_of([&] { static_cast<void>(Simulator(scene)); }),
            "/nowhere/key.npy: No such file or directory; check its name");
}

struct WrongIndenter {
  std::string text;
  std::string message;
};

TEST(WrongIndenter, IsRefusedInOneLine) {
  const std::string ball = "shape = \"sphere\"\nradius_mm = 9\nfriction = 1\n";
  const std::string still = "position_mm = [0, 0]\nload_n = 1\n";
  const std::string file = "folder/s.toml:";
  const std::vector<WrongIndenter> table = {
      {"shape = \"cube\"", file +
                               "3: key 'shape' in [[indenter]] is \"cube\"; allowed: \"sphere\", "
                               "\"ellipsoid\", \"cylinder\", \"punch\", \"height_map\""},
      {ball + "length_mm = 3\n" + still,
       file +
           "6: key 'length_mm' in [[indenter]] does not apply to shape = \"sphere\"; allowed: no "
           "such key"},
      {ball + "angle_deg = 3\npath = [{ time_s = 0, position_mm = [0, 0], load_n = 1 }]",
       file + "6: key 'angle_deg' in [[indenter]] comes with path; allowed: one of the two"},
      {ball + "motion = \"slide\"\n" + still,
       file + "6: key 'motion' in [[indenter]] is unknown here; allowed: shape, radius_mm, "
              "roughness_um, roughness_exponent, roughness_length_mm, friction, "
              "friction_variation, friction_variation_length_mm, substeps, path, position_mm, "
              "angle_deg, load_n"},
      {ball + "roughness_exponent = 0.5\n" + still,
       file +
           "6: key 'roughness_exponent' in [[indenter]] comes without roughness_um; allowed: both, "
           "or none"},
      {"shape = \"height_map\"\nheight_map = \"a.npy\"\nheight_map_size_mm = [300, 9]\n"
       "height_map_depth_mm = 1\nfriction = 1\n" +
           still,
       "folder/s.toml: indenter 1: height_map_size_mm is 300; on this skin it may be 160.644"},
      {"shape = \"punch\"\nradius_mm = 3\nedge_radius_mm = 4\nfriction = 1\n" + still,
       "folder/s.toml: indenter 1: edge_radius_mm is 4; it may be radius_mm"},
  };
  for (const auto& entry : table) {
    const std::string is =
        core_test::message_of([&] { static_cast<void>(parsed_scene(scene_text(entry.text))); });
    EXPECT_EQ(is, entry.message) << entry.text;
    EXPECT_EQ(is.find('\n'), std::string::npos);
  }
}

TEST(WrongIndenter, ALongPathAndADirectionSweepAreRefused) {
  const std::string ball =
      "shape = \"sphere\"\nradius_mm = 9\nfriction = 1\nsubsteps = 5\n"
      "path = [{ time_s = 0, position_mm = [0, 0], load_n = 1 },\n"
      "{ time_s = 1000, position_mm = [1, 0], load_n = 1 }]";
  EXPECT_NO_THROW(static_cast<void>(parsed_scene(scene_text(ball))));
  EXPECT_EQ(
      core_test::message_of(
          [&] { static_cast<void>(parsed_scene(scene_text(ball, "[time]\nframes = 5000"))); }),
      "folder/s.toml: indenter 1: it takes 25000 steps; its path may have 20000: fewer frames, "
      "substeps or seconds");
  EXPECT_EQ(
      core_test::message_of(
          [&] { static_cast<void>(parsed_scene("[direction_sweep]\n[[indenter]]\n" + ball)); }),
      "folder/s.toml:1: key 'direction_sweep' in the scene comes with [[indenter]]; allowed: one "
      "of the "
      "two");
}

}  // namespace
}  // namespace pillarfield
