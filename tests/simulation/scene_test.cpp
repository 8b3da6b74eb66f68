#include "pillarfield/scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>
#include <set>
#include <sstream>
#include <string>
#include <tuple>

#include "pillarfield/error.h"
#include "pillarfield/simulator.h"
#include "simulation/closed_form/contact_traction.h"
#include "simulation/indenter/indenter_path.h"
#include "simulation/scene/scene_limits.h"
#include "solve/plan_settings.h"

namespace pillarfield {
namespace {

const std::filesystem::path kScenes = PILLARFIELD_SCENES;

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kScenes)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// Keys of no table of numbers.
TEST(Scene, EveryKeyReachesItsPlace) {
  const Scene scene = parse_scene(R"(
title = "All keys"
[skin]
pillars = [30, 40]
sensel_pitch_mm = 0.5
[sensor]
adc_bits = 10
full_scale_counts = 1000
power_law_exponent = 1.25
power_law_reference_counts = 90
pillar_leak_edge = 0.01
pillar_leak_corner = 0.003
pillar_arm_mm = 0.224
shear_coefficient = [0.8, 1.2]
leak_inside = 0.05
leak_across = 0.02
hysteresis = 0.06
hysteresis_range_counts = 150
wires = { tile = [32, 16], row_ohm = 50, column_ohm = 40, sensel_ohm = 9000, tares = "offset" }
[surface]
bend_spread_counts_mm = 100
path = [{ time_s = 0, curvature_per_mm = [0, 0, 0] }, { time_s = 2, curvature_per_mm = [0.02, 0.01, -0.03] }]
[time]
rate_hz = 250
frames = 12
seed = 99
recording = 3
[solver]
estimator = "direct"
angles = true
uncertainty = true
friction_prior = [0.8, 0.3]
memory = false
[[contact]]
shape = "cylinder"
motion = "roll"
contact_radius_mm = 3
length_mm = 9
friction = 0.5
tangential_ratio = 0.4
path = [{time_s = 0, position_mm = [1, 2], load_n = 3}, {time_s = 2.5, position_mm = [-4, 5.5], load_n = 6}]
[[contact]]
shape = "flat_punch"
motion = "spin"
contact_radius_mm = 2
friction = 0.9
clockwise = true
position_mm = [7, -8]
load_n = 0.5
)",
                                  "all.toml");
  using std::tuple;
  EXPECT_EQ(scene.title, "All keys");
  EXPECT_EQ(tuple(scene.skin.rows, scene.skin.cols, scene.skin.sensel_pitch_mm.col_mm,
                  scene.skin.full_scale_counts, scene.sensor.adc_bits),
            tuple(60, 80, 0.5, 1000, 10));
  EXPECT_EQ(scene.skin.power_law.value().exponent, 1.25);
  EXPECT_EQ(scene.skin.power_law->reference_counts, 90);
  EXPECT_EQ(scene.sensor.hysteresis_range_counts, 150);
  const SensorEffects effects = Simulator(scene).calibration().effects;
  EXPECT_EQ(tuple(effects.pillar_leak->edge, effects.pillar_leak->corner, effects.arm_mm,
                  effects.shear_coefficient->x, effects.shear_coefficient->y,
                  effects.sensel_leak->inside, effects.sensel_leak->across, effects.memory),
            tuple(0.01, 0.003, 0.224, 0.8, 1.2, 0.05, 0.02, std::nullopt));
  const WireCrosstalk wires = effects.wires.value();
  EXPECT_EQ(tuple(wires.tile_rows, wires.tile_cols, wires.row_per_count, wires.column_per_count,
                  wires.idle_per_count, wires.tares),
            tuple(32, 16, 50 * (1 / 9e6), 40 * (1 / 9e6), 50 * (1 / 9e6), TareOrigin::offset));
  EXPECT_EQ(scene.bending.value().spread_counts_mm, 100);
  EXPECT_EQ(scene.bending->path.at(1).xy, -0.03);
  const Scene other = parse_scene(
      "[skin]\npillars = [2, 2]\n[sensor]\nresponse_curve = [[9, 8], [20, 30]]\n"
      "shear_coefficient = 0.9",
      "s");
  EXPECT_EQ(other.sensor.effects.curve.loads, (std::vector<double>{8, 30}));
  EXPECT_EQ(other.sensor.effects.shear_coefficient->y, 0.9);
  EXPECT_EQ(tuple(scene.rate_hz, scene.frames, scene.seed, scene.recording),
            tuple(250, 12U, 99U, 3U));
  EXPECT_EQ(tuple(scene.solver.estimator, scene.solver.angles, scene.solver.uncertainty,
                  scene.solver.unrelated_frames, scene.solver.friction_prior),
            tuple(Estimator::direct, true, true, true, std::vector{0.8, 0.3}));
  const auto& contacts = std::get<std::vector<ClosedFormContact>>(scene.load);
  const ContactKey last = contacts.at(0).path.at(1);
  EXPECT_EQ(
      tuple(contacts[0].shape, contacts[0].motion, last.time_s, last.x_mm, last.y_mm, last.load_n),
      tuple(ContactShape::cylinder, ContactMotion::roll, 2.5, -4, 5.5, 6));
  const ContactKey only = contacts.at(1).path.at(0);
  EXPECT_EQ(tuple(contacts[1].clockwise, only.y_mm, only.load_n), tuple(true, -8, 0.5));
}

/// A number in a range, the smaller the later its row.
double within(const Range& range, std::size_t row = 0) {
  const auto place = static_cast<double>(row + 1);
  return range.low + std::min(range.high - range.low, 1.0) / (2 * place * place);
}

TEST(Scene, EveryNumberOfATableReachesItsPlace) {
  const auto scene_with = [](const char* section, std::string_view key, const Range& range) {
    return parse_scene(fmt::format("skin.pillars = [2, 2]\n{}{} = {}", section, key, within(range)),
                       "number.toml");
  };
  for (const auto& [key, member, range] : kSkinQuantities) {
    EXPECT_EQ(scene_with("skin.", key, range).skin.*member, within(range)) << key;
  }
  for (const auto& [key, member, range] : kSensorQuantities) {
    EXPECT_EQ(scene_with("sensor.", key, range).sensor.*member, within(range)) << key;
  }
  for (const PlanSetting& setting : kPlanSettings) {
    if (!setting.has(kIsKey)) continue;
    const Scene scene = scene_with("solver.", setting.name, setting.range);
    EXPECT_EQ(scene.solver.*setting.member, within(setting.range)) << setting.name;
    SolverPlan plan;
    set_solver(plan, scene);
    const std::optional<double> value = setting.number.get(plan);
    EXPECT_EQ(value.value_or(within(setting.range)), within(setting.range)) << setting.name;
  }
}

/// A part of a scene that has all numbers of its table that apply to it, each another one.
template <class Part, std::size_t rows>
std::string with_numbers(std::string text, const Part& part,
                         const std::array<PartQuantity<Part>, rows>& table) {
  for (std::size_t row = 0; row < rows; ++row) {
    const auto& [quantity, required, applies] = table[row];
    if (applies(part)) text += fmt::format("{} = {}\n", quantity.key, within(quantity.range, row));
  }
  return "skin.pillars = [20, 20]\n" + text + "position_mm = [0, 0]\nload_n = 1\n";
}

template <class Part, std::size_t rows>
void expect_numbers(const Part& part, const std::array<PartQuantity<Part>, rows>& table) {
  for (std::size_t row = 0; row < rows; ++row) {
    const auto& [quantity, required, applies] = table[row];
    if (!applies(part)) continue;
    EXPECT_EQ(part.*quantity.member, within(quantity.range, row)) << quantity.key;
  }
}

TEST(Scene, EveryNumberOfAPartReachesItsPlace) {
  ClosedFormContact roller;  // All numbers apply to it.
  roller.shape = ContactShape::cylinder;
  roller.motion = ContactMotion::roll;
  const Scene rolled =
      parse_scene(with_numbers("[[contact]]\nshape = \"cylinder\"\nmotion = \"roll\"\n", roller,
                               kContactQuantities),
                  "s.toml");
  expect_numbers(std::get<std::vector<ClosedFormContact>>(rolled.load).at(0), kContactQuantities);
  for (const auto& [shape, head] :
       {std::pair{IndenterShape::cylinder, "shape = \"cylinder\"\n"},
        {IndenterShape::height_map,
         "shape = \"height_map\"\nheight_map = \"a.npy\"\nheight_map_size_mm = [9, 8]\n"}}) {
    Indenter indenter;
    indenter.shape = shape;
    const Scene pressed = parse_scene(
        with_numbers("[[indenter]]\n" + std::string(head), indenter, kIndenterQuantities),
        "s.toml");
    EXPECT_EQ(pressed.indenters.at(0).shape, shape);
    expect_numbers(pressed.indenters[0], kIndenterQuantities);
  }
}

TEST(Scene, WhatIsNotListedIsAbsent) {
  const Scene scene = parse_scene("[skin]\nsize_mm = [20, 10]", "bare.toml");
  EXPECT_TRUE(std::get<std::vector<ClosedFormContact>>(scene.load).empty());
  EXPECT_FALSE(scene.skin.full_scale_counts);
  EXPECT_FALSE(scene.sensor.adc_bits);
  EXPECT_FALSE(scene.solver.parity_tolerance_counts);
  EXPECT_FALSE(scene.solver.estimator);
  EXPECT_FALSE(scene.solver.angles);
  EXPECT_EQ(scene.skin.counts_per_newton, 320);
  EXPECT_EQ(scene.rate_hz, 100);
  EXPECT_TRUE(Simulator(scene).calibration().empty());
}

TEST(Scene, ASizeHoldsWholePillars) {
  const auto skin_of = [](const std::string& keys) {
    return parse_scene("[skin]\nsensel_pitch_mm = 0.5\n" + keys, "size.toml").skin;
  };
  EXPECT_EQ(skin_of("size_mm = [7.9, 3.2]").cols, 14U);
  EXPECT_EQ(skin_of("size_mm = [7.9, 3.2]").rows, 6U);
  EXPECT_EQ(skin_of("size_mm = [7, 3]").cols, 14U);
  EXPECT_EQ(skin_of("pillars = [3, 7]").rows, 6U);
  // 0.3 / (2 * 0.05) is just below 3 in binary.
  EXPECT_EQ(parse_scene("[skin]\nsensel_pitch_mm = 0.05\nsize_mm = [0.3, 0.3]", "s").skin.rows, 6U);
}

TEST(Scene, AContactHasItsRadiusAtItsHeaviestLoadUnlessGivenOtherwise) {
  const auto reference_load = [](const std::string& line) {
    const Scene scene = parse_scene(
        "[skin]\nsize_mm = [9, 9]\n[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\n"
        "contact_radius_mm = 2\npath = [{ time_s = 0, position_mm = [0, 0], load_n = 3 },\n"
        "  { time_s = 1, position_mm = [0, 0], load_n = 7 }]\n" +
            line,
        "contact.toml");
    return std::get<std::vector<ClosedFormContact>>(scene.load).at(0).reference_load_n;
  };
  EXPECT_EQ(reference_load(""), 7);
  EXPECT_EQ(reference_load("reference_load_n = 5"), 5);
}

TEST(Scene, ADirectionSweepSetsTheSizeOfTheSkin) {
  const std::string keys =
      "directions = 8\ninclinations = 5\nmagnitudes_n = [0.1, 1]\nmax_theta_deg = 60";
  const Scene scene = parse_scene("[direction_sweep]\n" + keys, "c");
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.skin.pillar_rows(), 10U);
  EXPECT_EQ(scene.skin.pillar_cols(), 8U);
  EXPECT_EQ(std::get<DirectionSweep>(scene.load).max_theta_deg, 60);
}

/// A shape sets the skin's surface and, for bending, its curvature.
TEST(SceneSurface, GivesTheSkinAShapeAndItsCurvature) {
  const std::string skin = "skin.pillars = [20, 20]\n[surface]\n";
  const auto scene = [&](const std::string& keys) { return parse_scene(skin + keys, "s.toml"); };
  EXPECT_FALSE(scene("").skin.surface);
  const std::string cylinder = "shape = \"cylinder\"\nradius_mm = 60\naxis_deg = 30\n";
  const Scene unbent = scene(cylinder);
  EXPECT_EQ(unbent.skin.surface.value().radius_mm, 60);
  EXPECT_EQ(unbent.skin.surface.value().axis_deg, 30);
  EXPECT_FALSE(unbent.bending);
  const CurvatureKey bent =
      scene(cylinder + "bend_spread_counts_mm = 100\n").bending.value().path.at(0);
  EXPECT_NEAR(bent.x, 0.25 / 60, 1e-12);
  EXPECT_NEAR(bent.y, 0.75 / 60, 1e-12);
  EXPECT_NEAR(bent.xy, -std::sqrt(3) / 2 / 60, 1e-12);
  EXPECT_EQ(scene(cylinder + "bend_spread_counts_mm = 100\ncurvature_per_mm = [0, 0, 0]\n")
                .bending.value()
                .path.at(0)
                .x,
            0);
}

/// Heights of a map are sampled at the pillars: key.npy, 28 x 12 mm, on a skin of about 25 x 10 mm.
TEST(SceneSurface, SamplesAHeightMapAtThePillars) {
  const auto scene = [](const std::string& size) {
    return parse_scene(
        "skin.pillars = [8, 20]\n[surface]\nshape = \"height_map\"\nheight_map = "
        "\"key.npy\"\nheight_map_size_mm = " +
            size + "\nheight_map_depth_mm = 1.5\n",
        std::string(PILLARFIELD_SCENES) + "/touch/s.toml");
  };
  const Simulator simulator(scene("[28, 12]"));
  const Surface surface = simulator.scene().skin.surface.value();
  EXPECT_EQ(surface.shape, SurfaceShape::height_map);
  ASSERT_EQ(surface.heights_mm.size(), 160U);
  const auto [low, high] = std::ranges::minmax(surface.heights_mm);
  EXPECT_GE(low, 0);
  EXPECT_LE(high, 1.5);
  EXPECT_GT(high - low, 1);
  EXPECT_THROW(Simulator(scene("[20, 12]")), Error);
}

TEST(ShippedScenes, BeginWithADescription) {
  const auto scenes = shipped_scenes();
  EXPECT_GE(scenes.size(), 10U);
  for (const auto& path : scenes) {
    EXPECT_EQ(text_of(path).substr(0, 2), "# ") << path << " has no head";
  }
}

/// The truth's total load is that of the contacts and indenters, so none of them reaches beyond the
/// skin.
void expect_whole_load(const Scene& scene, double time_s, const ForceField& truth) {
  const auto* contacts = std::get_if<std::vector<ClosedFormContact>>(&scene.load);
  if (!contacts) return;
  double load = 0;
  for (const ClosedFormContact& contact : *contacts) load += state_at(contact, time_s).load_n;
  for (const Indenter& indenter : scene.indenters) load += state_at(indenter, time_s).load_n;
  double sum = 0;
  for (const float normal : truth.normal) sum += double{normal};
  EXPECT_NEAR(sum, load, 1e-6 * load);
}

template <class Count>
void expect_no_saturation(const FrameBuffer& raw, double full_scale) {
  for (const Count reading : raw.readings<Count>()) ASSERT_LT(reading, full_scale);
}

void expect_frame(const Simulator& simulator, std::uint64_t index) {
  const Skin& skin = simulator.scene().skin;
  FrameBuffer raw(simulator.sensel_type(), skin.rows, skin.cols);
  ForceField truth(skin);
  simulator.render(index, raw, truth);
  expect_whole_load(simulator.scene(), simulator.time_of(index), truth);
  if (simulator.sensel_type() == SenselType::u8) {
    expect_no_saturation<std::uint8_t>(raw, skin.full_scale_counts.value());
  } else if (simulator.sensel_type() == SenselType::f32) {
    const auto readings = raw.readings<float>();
    EXPECT_TRUE(std::ranges::all_of(readings, [](float v) { return std::isfinite(v); }));
  }
}

TEST(ShippedScenes, ParseAndRenderTheirFirstAndLastFrame) {
  for (const auto& path : shipped_scenes()) {
    SCOPED_TRACE(path.filename().string());
    const Simulator simulator(load_scene(path));
    EXPECT_FALSE(simulator.scene().title.empty());
    expect_frame(simulator, 0);
    expect_frame(simulator, simulator.scene().frames - 1);
  }
}

double reach_of(const ClosedFormContact& contact, const ContactKey& state) {
  const double radius = contact_radius_mm(contact, state.load_n);
  return contact.shape == ContactShape::cylinder ? std::hypot(radius, contact.length_mm / 2)
                                                 : radius;
}

/// The closed forms no longer solve the contact problem if contacts overlap.
TEST(ShippedScenes, KeepTheirContactsApart) {
  for (const auto& path : shipped_scenes()) {
    const Scene scene = load_scene(path);
    const auto* contacts = std::get_if<std::vector<ClosedFormContact>>(&scene.load);
    if (!contacts) continue;
    for (std::uint32_t frame = 0; frame < scene.frames; ++frame) {
      const double time = frame / scene.rate_hz;
      for (auto a = contacts->begin(); a != contacts->end(); ++a) {
        for (auto b = contacts->begin(); b != a; ++b) {
          const ContactKey at_a = state_at(*a, time);
          const ContactKey at_b = state_at(*b, time);
          EXPECT_GT(std::hypot(at_a.x_mm - at_b.x_mm, at_a.y_mm - at_b.y_mm),
                    reach_of(*a, at_a) + reach_of(*b, at_b))
              << path << " frame " << frame << " contacts " << b - contacts->begin() << " and "
              << a - contacts->begin();
        }
      }
    }
  }
}

/// The keys that a scene may have where this unknown one stands, which the error names.
std::vector<std::string> keys_beside(const std::string& text) {
  std::vector<std::string> keys;
  try {
    static_cast<void>(parse_scene(text + "\nunknown = 1", "s.toml"));
  } catch (const Error& error) {
    std::istringstream words{std::string(error.mend())};
    words.ignore(9);  // "allowed: "
    for (std::string key; words >> key;) keys.push_back(key.substr(0, key.find(',')));
  }
  return keys;
}

/// The page's example is a scene, and its tables name every key that a scene may have.
TEST(ScenesPage, HasAnExampleThatParsesAndEveryKey) {
  const std::string page = text_of(PILLARFIELD_SCENES_PAGE);
  const std::size_t begin = page.find("```toml\n");
  const std::size_t end = page.find("```", begin + 8);
  ASSERT_NE(end, std::string::npos);
  EXPECT_NO_THROW(static_cast<void>(parse_scene(page.substr(begin + 8, end - begin - 8), "page")));
  const std::string skin = "skin.size_mm = [20, 20]\n";
  const std::string at = "position_mm = [0, 0]\nload_n = 1\nfriction = 1\n";
  std::set<std::string> keys;
  const std::vector<std::string> texts = {
      "[skin]\nsize_mm = [20, 20]",
      skin + "[sensor]",
      skin + "[sensor.wires]\nsensel_ohm = 9",
      skin + "[time]",
      skin + "[solver]",
      skin + "[surface]\nshape = \"cylinder\"\nradius_mm = 60",
      "[direction_sweep]",
      skin +
          "[[contact]]\nshape = \"cylinder\"\nmotion = \"roll\"\ncontact_radius_mm = 3\n"
          "length_mm = 9\ntangential_ratio = 0.4\n" +
          at,
      skin + "[[contact]]\nshape = \"flat_punch\"\nmotion = \"spin\"\ncontact_radius_mm = 2\n" + at,
      skin + "[[indenter]]\nshape = \"ellipsoid\"\nradii_mm = [9, 8, 7]\n" + at,
      skin + "[[indenter]]\nshape = \"cylinder\"\nradius_mm = 9\nlength_mm = 9\n" + at,
      skin +
          "[[indenter]]\nshape = \"height_map\"\nheight_map = \"a.npy\"\n"
          "height_map_size_mm = [9, 9]\nheight_map_depth_mm = 1\n" +
          at};
  for (const std::string& text : texts) {
    const auto beside = keys_beside(text);
    EXPECT_GT(beside.size(), 2U) << text;
    keys.insert(beside.begin(), beside.end());
  }
  EXPECT_GT(keys.size(), 70U);
  for (const std::string& key : keys) {
    EXPECT_NE(page.find("| `" + key + "`"), std::string::npos) << key;
  }
}

/// A number as the page has it: "0.01", "10⁻⁶".
std::string number_words(double value) {
  constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  const double power = value > 0 ? std::log10(value) : 0;
  if (std::abs(power) < 4 || power != std::round(power)) {
    return (value < 0 ? "−" : "") + fmt::format("{}", std::abs(value));
  }
  std::string text = power < 0 ? "10⁻" : "10";
  for (const char digit : fmt::format("{}", std::abs(power))) text += kDigits[digit - '0'];
  return text;
}

/// The page states the range of every number of a table.
TEST(ScenesPage, HasEveryRange) {
  const std::string page = text_of(PILLARFIELD_SCENES_PAGE);
  const auto expect_row = [&](std::string_view key, const Range& range) {
    const std::string row = fmt::format("| `{}` | {}{} to {}{}", key,
                                        range.open_low ? "above " : "", number_words(range.low),
                                        range.open_high ? "below " : "", number_words(range.high));
    EXPECT_NE(page.find(row), std::string::npos) << row;
  };
  for (const auto& [key, member, range] : kSkinQuantities) expect_row(key, range);
  for (const auto& [key, member, range] : kSensorQuantities) expect_row(key, range);
  for (const auto& each : kContactQuantities) expect_row(each.quantity.key, each.quantity.range);
  for (const auto& each : kIndenterQuantities) {
    if (each.quantity.member == &Indenter::edge_radius_mm) continue;  // Up to that of its shape.
    expect_row(each.quantity.key, each.quantity.range);
  }
  for (const PlanSetting& setting : kPlanSettings) {
    if (setting.has(kIsKey)) expect_row(setting.name, setting.range);
  }
}

}  // namespace
}  // namespace pillarfield
