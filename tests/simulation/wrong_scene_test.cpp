#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/scene.h"

namespace pillarfield {
namespace {

std::string message_of(const std::string& text) {
  try {
    static_cast<void>(parse_scene(text, "s.toml"));
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

struct WrongScene {
  const char* text;
  const char* message;
};

/// A skin of one line, then what is given.
std::string on_skin(const char* text) { return std::string("skin.size_mm = [20, 20]\n") + text; }

void expect_message(const std::string& text, const std::string& message) {
  const std::string is = message_of(text);
  EXPECT_EQ(is, message) << text;
  EXPECT_EQ(is.find('\n'), std::string::npos);
}

TEST(WrongScene, SkinSensorTimeAndSolver) {
  const std::vector<WrongScene> table = {
      {"sensor = 3", "s.toml:2: key 'sensor' in the scene is 3; allowed: a table, [sensor]"},
      {"[sensor]\n\nnoise = 1",
       "s.toml:4: key 'noise' in [sensor] is unknown here; allowed: leak_inside, "
       "leak_across, pillar_leak_edge, pillar_leak_corner, hysteresis, creep_per_decade, "
       "dead_zone_counts, gain_spread, tare_counts, tare_spread_counts, drift_counts_per_s, "
       "noise_counts, dead_share, pillar_arm_mm, shear_coefficient, "
       "hysteresis_range_counts, response_curve, adc_bits, full_scale_counts, wires, "
       "power_law_exponent, power_law_reference_counts"},
      {"[sensor]\nnoise_counts = -1",
       "s.toml:3: key 'noise_counts' in [sensor] is -1; allowed: a number in [0, 1000000]"},
      {"[sensor]\npower_law_exponent = 1.2",
       "s.toml:2: key 'power_law_reference_counts' in [sensor] is missing; allowed: a number in "
       "[0.001, 1000000]"},
      {"[sensor]\nresponse_curve = [[1, 2], [3]]",
       "s.toml:3: key 'response_curve' in [sensor] has an element that is not such a pair; "
       "allowed: a "
       "list of pairs, each a number in (0, 1000000000]"},
      {"[sensor]\nresponse_curve = [[1, 2], [3, 4]]\npower_law_exponent = 2\n"
       "power_law_reference_counts = 9",
       "s.toml:3: key 'response_curve' in [sensor] comes with power_law_exponent; allowed: one of "
       "the two"},
      {"[sensor]\nresponse_curve = [[1, 2]]",
       "s.toml: the response curve has 1 readings and 1 loads; it needs 2 to 64 of each"},
      {"[sensor]\nwires = { row_ohm = 30 }",
       "s.toml:3: key 'sensel_ohm' in [wires] is missing; allowed: resistance at full scale"},
      {"[sensor]\nwires = { sensel_ohm = 1, row_ohm = 30 }",
       "s.toml: wire_row_per_count is 0.117647; it must be a number in [0, 0.1]"},
      {"[surface]\nshape = \"cylinder\"\nradius_mm = 3",
       "s.toml: the skin covers more than a whole cylinder of radius 3 mm; give a radius of at "
       "least "
       "3.02 mm"},
      {"[surface]\nshape = \"height_map\"\nheight_map = \"a.bmp\"",
       "s.toml:4: key 'height_map' in [surface] is \"a.bmp\"; allowed: the path of a .npy file, "
       "from the scene's folder"},
      {"[sensor]\nadc_bits = 8\nfull_scale_counts = 256",
       "s.toml:4: key 'full_scale_counts' in [sensor] is 256; allowed: a whole number from 1 to "
       "255"},
      {"[skin]\nthreshold_counts = 9\n[sensor]\nadc_bits = 3",
       "s.toml:5: key 'adc_bits' in [sensor] gives a full scale of 7; allowed: more than "
       "threshold_counts, 9"},
      {"[solver]\nestimator = \"magic\"",
       R"(s.toml:3: key 'estimator' in [solver] is "magic"; allowed: "direct", "paper", "contact")"},
      {"[solver]\nestimator = \"paper\"\nuncertainty = true",
       "s.toml:4: key 'uncertainty' in [solver] comes with the paper's estimator, which has none; "
       "allowed: estimator = \"direct\" or \"contact\""},
  };
  for (const auto& [text, message] : table) {
    // [skin] given again would be a duplicate, so the size goes into it.
    const std::string whole = text;
    if (whole.starts_with("[skin]")) {
      expect_message("\n[skin]\nsize_mm = [9, 9]" + whole.substr(6),
                     std::string(message).replace(7, 1, "6"));
    } else {
      expect_message(on_skin(text), message);
    }
  }
}

TEST(WrongScene, SizeOfTheSkin) {
  const std::vector<WrongScene> table = {
      {"",
       "s.toml: key 'size_mm' in [skin] is missing; allowed: size_mm = [x, y] or pillars = "
       "[rows, columns]"},
      {"[skin]\nsize_mm = [5]",
       "s.toml:2: key 'size_mm' in [skin] is a list of 1; allowed: a list of 2, each a number in "
       "(0, 100000000]"},
      {"[skin]\npillars = [3, 3]\nsize_mm = [9, 9]",
       "s.toml:2: key 'pillars' in [skin] comes with size_mm; allowed: one of the two"},
      {"[skin]\nsize_mm = [\n5,\n-5]",
       "s.toml:4: key 'size_mm' in [skin] has an element that is "
       "-5; allowed: a list of 2, each a number in (0, 100000000]"},
      {"[skin]\nsize_mm = [1, 9]",
       "s.toml:2: key 'size_mm' in [skin] means 7 x 0 pillars; allowed: "
       "1 to 32767 each way, 25000000 in all"},
      {"[skin]\npillars = [32767, 32767]",
       "s.toml:2: key 'pillars' in [skin] means 32767 x 32767 "
       "pillars; allowed: 1 to 32767 each way, 25000000 in all"},
      {"[skin]\nsize_mm = [9, 9]\n[direction_sweep]",
       "s.toml:2: key 'size_mm' in [skin] comes with [direction_sweep]; "
       "allowed: no size: the sweep sets it"},
      {"[direction_sweep]\ninclinations = 30000\nmagnitudes_n = [1, 2]",
       "s.toml:2: key 'inclinations' in [direction_sweep] means 60000 x 72 pillars; allowed: 1 to "
       "32767 each "
       "way, 25000000 in all"},
  };
  for (const auto& [text, message] : table) expect_message(text, message);
}

/// A contact that lacks nothing, on lines 2 to 7, then what is given.
std::string ball(const char* text) {
  return on_skin(
             "[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\ncontact_radius_mm = 5\n"
             "position_mm = [0, 0]\nload_n = 1\n") +
         text;
}

TEST(WrongScene, KeysThatDoNotGoTogether) {
  const std::vector<WrongScene> table = {
      {"friction = 0.5",
       "s.toml:8: key 'friction' in [[contact]] does not apply to shape = "
       "\"sphere\", motion = \"press\"; allowed: no such key"},
      {"path = [{time_s = 0, position_mm = [0, 0], load_n = 1}]",
       "s.toml:6: key 'position_mm' in [[contact]] comes with path; allowed: one of the two"},
      {"[direction_sweep]",
       "s.toml:8: key 'direction_sweep' in the scene comes with [[contact]]; allowed: one of the "
       "two"},
  };
  for (const auto& [text, message] : table) expect_message(ball(text), message);
}

TEST(WrongScene, Contacts) {
  const std::vector<WrongScene> table = {
      {"contact = 5",
       "s.toml:2: key 'contact' in the scene is 5; allowed: a list of tables, [[contact]]"},
      {"[[contact]]\nshape = \"cylinder\"",
       R"(s.toml:2: key 'motion' in [[contact]] is missing; allowed: "press", "slide", "roll")"},
      {"[[contact]]\nshape = \"cylinder\"\nmotion = \"spin\"",
       "s.toml:4: key 'motion' in [[contact]] does not go with the shape: shape = \"cylinder\", "
       "motion = \"spin\"; allowed: \"press\", \"slide\", \"roll\""},
      {"[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\ncontact_radius_mm = 2\nload_n = 1",
       "s.toml:2: key 'position_mm' in [[contact]] is missing; allowed: a list of 2, [x, y] in "
       "millimetres"},
      {"[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\ncontact_radius_mm = 2\npath = [\n"
       "{time_s = 1, position_mm = [0, 0], load_n = 1},\n"
       "{time_s = 1, position_mm = [0, 0], load_n = 1}]",
       "s.toml:8: key 'time_s' in path of [[contact]] is 1; allowed: more than that of the key "
       "before, 1"},
  };
  for (const auto& [text, message] : table) expect_message(on_skin(text), message);
}

TEST(WrongScene, TextThatIsNotToml) {
  for (const std::string& text :
       {std::string("[skin"), std::string("a = "), std::string("a = 1\na = 2"),
        std::string("\xff\xfe"), std::string("x = [1, 2"), std::string("\""),
        std::string("a = 99999999999999999999999"), std::string("[a]\n[a]"),
        "a = " + std::string(100000, '[')}) {
    const std::string message = message_of(text).substr(0, 200);
    EXPECT_EQ(message.find("s.toml:"), 0U) << message;
    EXPECT_NE(message.find("is not TOML"), std::string::npos) << message;
  }
}

std::string repeated(std::size_t times, const std::string& part) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

TEST(WrongScene, KeysOfManyPartsAreRefused) {
  for (const std::size_t levels : {16UL, 20'000UL, 100'000UL}) {
    const std::string key = repeated(levels, "a.") + "a";
    const std::string quoted = repeated(levels, "\"a.b\" . 'c' .") + "a";
    for (const std::string& text :
         {key + " = 1", "[" + key + "]", "[[" + key + "]]", "x = { " + key + " = 1 }",
          "x = [1, { b = 1, " + key + " = 1 }]", quoted + " = 1", "[ " + quoted + " ]",
          R"(x = [ """a""""", { )" + key + " = 1 } ]", "x = [ '''a''''', { " + key + " = 1 } ]",
          "x = 'a' # \"\n" + key + " = 1", "x = \"\\\"\"\n" + key + " = 1"}) {
      const std::string message = message_of(text).substr(0, 80);
      EXPECT_TRUE(message.starts_with("s.toml:1: a key has more than 16 parts") ||
                  message.starts_with("s.toml:2: a key has more than 16 parts"))
          << message << " for " << text.substr(0, 60);
    }
  }
  const std::string most = repeated(15, "a.") + "a = 1";
  EXPECT_NE(message_of(on_skin(most.c_str())).find("key 'a' in the scene is unknown"),
            std::string::npos);
}

TEST(WrongScene, DepthsThatAddUpAreNoDanger) {
  const std::string key = repeated(15, "a.") + "a";
  const std::string tables = repeated(250, "{" + key + " = ") + "1" + repeated(250, "}");
  for (const std::string& text :
       {repeated(100'000, "{a="), repeated(100'000, "["), repeated(100'000, "[{a="), tables}) {
    const std::string message = message_of(fmt::format("[{0}]\n{0} = {1}", key, text));
    EXPECT_TRUE(message.starts_with("s.toml")) << message.substr(0, 80);
  }
}

TEST(WrongScene, DotsThatAreNotInKeysAreAllowed) {
  const std::string dots(1000, '.');
  const std::string numbers = repeated(200, "0.5, ") + "0.5";
  EXPECT_EQ(
      message_of("# " + dots + "\ntitle = \"" + dots + "\" # " + dots + "\n[direction_sweep]\n" +
                 "directions = 2\nmagnitudes_n = [" + numbers + "]"),
      "no error");
  EXPECT_EQ(message_of(on_skin("") + "title = '''\n" + dots + "\n'''"), "no error");
}

/// One random edit: a character replaced, a piece cut out, or a piece said twice.
std::string damaged(std::string text, std::mt19937_64& random) {
  static constexpr std::string_view kCharacters = "0159.-e[]{}=,\"'#\n x_ninf\xff\x00";
  const std::size_t at = random() % text.size();
  const std::size_t length = random() % 20;
  switch (random() % 3) {
    case 0:
      text[at] = kCharacters[random() % kCharacters.size()];
      break;
    case 1:
      text.erase(at, length);
      break;
    default:
      text.insert(at, text.substr(random() % text.size(), length));
      break;
  }
  return text;
}

TEST(WrongScene, AnyDamageGivesASceneOrAnErrorOfOneLine) {
  const std::string whole = ball(
      "[sensor]\nadc_bits = 8\nnoise_counts = 0.5\ngain_spread = 0.1\n[time]\nframes = 10\n"
      "[[contact]]\nshape = \"cylinder\"\nmotion = \"roll\"\ncontact_radius_mm = 3\n"
      "length_mm = 9\nfriction = 0.5\ntangential_ratio = 0.4\n"
      "path = [{time_s = 0, position_mm = [1, 2], load_n = 3}]\n");
  EXPECT_EQ(message_of(whole), "no error");
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text = damaged(whole, random);
    if (trial % 2 == 0) text = damaged(text, random);
    const std::string message = message_of(text);
    EXPECT_EQ(message.find_first_of("\r\n"), std::string::npos) << message;
    EXPECT_TRUE(message == "no error" || message.starts_with("s.toml")) << message;
  }
}

TEST(WrongScene, FilesThatCannotBeRead) {
  for (const char* path : {"no/such/scene.toml", "/", ""}) {
    EXPECT_THROW(static_cast<void>(load_scene(path)), Error) << path;
  }
}

}  // namespace
}  // namespace pillarfield
