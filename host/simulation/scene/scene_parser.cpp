#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/input_file.h"
#include "pillarfield/error.h"
#include "pillarfield/scene.h"
#include "simulation/closed_form/direction_sweep.h"
#include "simulation/scene/indenter_section.h"
#include "simulation/scene/named_value.h"
#include "simulation/scene/path_section.h"
#include "simulation/scene/scene_limits.h"
#include "simulation/scene/surface_section.h"
#include "simulation/scene/toml_section.h"
#include "skin/effect_parameters.h"

namespace pillarfield {
namespace {

/// Reads the numbers of a table into the members of `part`.
template <class Part, std::size_t count>
void read_quantities(TomlSection& section, const std::array<Quantity<Part>, count>& quantities,
                     Part& part) {
  for (const auto& [key, member, range] : quantities) {
    if (const auto value = section.number(key, range)) part.*member = *value;
  }
}

// [sensor]

/// Full scale of the sensor: from the scene, else the converter's largest value.
std::optional<double> read_full_scale(TomlSection& section, const SensorModel& sensor) {
  const std::optional<double> largest = full_scale_of(sensor);
  if (!largest) return section.number("full_scale_counts", kFullScaleCounts);
  const auto whole = section.whole_number("full_scale_counts", 1, std::lround(*largest));
  return whole ? static_cast<double>(*whole) : largest;
}

/// Refuses a full scale that does not exceed the threshold.
void check_full_scale(const TomlSection& section, const Skin& skin) {
  if (!skin.full_scale_counts || *skin.full_scale_counts > skin.threshold_counts) return;
  section.fail(section.has("full_scale_counts") ? "full_scale_counts" : "adc_bits",
               fmt::format("gives a full scale of {}", *skin.full_scale_counts),
               fmt::format("more than threshold_counts, {}", skin.threshold_counts));
}

std::optional<PowerLaw> read_power_law(TomlSection& section) {
  constexpr std::string_view kExponent = "power_law_exponent";
  constexpr std::string_view kReference = "power_law_reference_counts";
  const auto exponent = section.number(kExponent, kPowerLawExponent);
  const auto reference = section.number(kReference, kPowerLawReference);
  if (!exponent && !reference) return std::nullopt;
  if (!exponent) section.fail_missing(kExponent, kPowerLawExponent.text());
  if (!reference) section.fail_missing(kReference, kPowerLawReference.text());
  return PowerLaw{*exponent, *reference};
}

/// Reads the knots of a response curve.
ResponseCurve read_response_curve(TomlSection& section) {
  ResponseCurve curve;
  const auto knots = section.pairs("response_curve", kCurveCounts);
  if (!knots) return curve;
  for (const auto& [reading, load] : *knots) {
    if (!curve.empty() && !(reading > curve.readings.back() && load > curve.loads.back())) {
      section.fail("response_curve",
                   fmt::format("has [{}, {}] after [{}, {}]", reading, load, curve.readings.back(),
                               curve.loads.back()),
                   "readings and loads that increase");
    }
    curve.readings.push_back(reading);
    curve.loads.push_back(load);
  }
  if (section.has("power_law_exponent")) {
    section.fail("response_curve", "comes with power_law_exponent", "one of the two");
  }
  return curve;
}

std::optional<ShearCoefficient> read_shear_coefficient(TomlSection& section) {
  constexpr std::string_view kKey = "shear_coefficient";
  if (section.is_list(kKey)) {
    const auto xy = *section.numbers(kKey, 2, kShearCoefficient);
    return ShearCoefficient{xy[0], xy[1]};
  }
  const auto both = section.number(kKey, kShearCoefficient);
  return both ? std::optional(ShearCoefficient{*both, *both}) : std::nullopt;
}

std::optional<WireCrosstalk> read_wires(TomlSection section, const Skin& skin) {
  if (!section.is_present()) return std::nullopt;
  WireCrosstalk wires;
  const double row_ohm = section.number("row_ohm", kWireOhm).value_or(0);
  const double column_ohm = section.number("column_ohm", kWireOhm).value_or(0);
  const auto sensel_ohm = section.number("sensel_ohm", kSenselOhm);
  if (!sensel_ohm) section.fail_missing("sensel_ohm", "resistance at full scale");
  const double count_siemens = 1 / (*sensel_ohm * full_scale_or_255(skin));
  wires.row_per_count = wires.idle_per_count = row_ohm * count_siemens;
  wires.column_per_count = column_ohm * count_siemens;
  wires.tares = read_name(section, "tares", kTareOrigins).value_or(wires.tares);
  if (const auto tile = section.numbers("tile", 2, kTileSensels)) {
    wires.tile_rows = static_cast<std::uint32_t>((*tile)[0]);
    wires.tile_cols = static_cast<std::uint32_t>((*tile)[1]);
    if (wires.tile_rows != (*tile)[0] || wires.tile_cols != (*tile)[1]) {
      section.fail("tile", "has a fraction", "whole numbers, [rows, columns]");
    }
  }
  section.finish();
  return wires;
}

/// Reads the effects whose keys are their parameters; zero is no effect.
SensorEffects read_effects(TomlSection& section) {
  constexpr std::string_view kWithKeys[] = {"curve", "shear_coefficient", "wires", "memory",
                                            "arm",   "residual"};
  const auto find = [&](const EffectParameter& asked) -> std::optional<std::vector<double>> {
    if (std::ranges::count(kWithKeys, asked.effect) > 0) return std::nullopt;
    const double value = section.number(asked.name, asked.range).value_or(0);
    if (value == 0) return std::nullopt;
    return std::vector<double>{value};
  };
  return effects_of(find, "[sensor]", false);
}

void read_sensor(TomlSection section, Scene& scene) {
  SensorEffects& effects = scene.sensor.effects;
  effects = read_effects(section);
  read_quantities(section, kSensorQuantities, scene.sensor);
  effects.arm_mm = section.number("pillar_arm_mm", kPillarArmMm);
  effects.shear_coefficient = read_shear_coefficient(section);
  scene.sensor.hysteresis_range_counts =
      section.number("hysteresis_range_counts", kHysteresisRangeCounts);
  effects.curve = read_response_curve(section);
  if (const auto bits = section.whole_number("adc_bits", 1, kMaxAdcBits)) {
    scene.sensor.adc_bits = static_cast<int>(*bits);
  }
  scene.skin.full_scale_counts = read_full_scale(section, scene.sensor);
  effects.wires = read_wires(section.table("wires"), scene.skin);
  scene.skin.power_law = read_power_law(section);
  section.finish();
  check_full_scale(section, scene.skin);
}

// [time] and [solver]

void read_time(TomlSection section, Scene& scene) {
  scene.rate_hz = section.number("rate_hz", kRateHz).value_or(scene.rate_hz);
  if (const auto frames = section.whole_number("frames", 1, kMaxFrames)) {
    scene.frames = static_cast<std::uint32_t>(*frames);
  }
  if (const auto seed = section.whole_number("seed", 0, std::numeric_limits<std::int64_t>::max())) {
    scene.seed = static_cast<std::uint64_t>(*seed);
  }
  if (const auto number = section.whole_number("recording", 0, kMaxRecording)) {
    scene.recording = static_cast<std::uint32_t>(*number);
  }
  section.finish();
}

/// Reads the prior of friction.
void read_friction(TomlSection& section, FrictionKnowledge& friction) {
  friction.given = section.number("friction", kFrictions);
  friction.bound = section.number("friction_bound", kFrictionBound);
  if (const auto prior =
          section.numbers("friction_prior", 2, {kPriorSpread.low, kFrictions.high})) {
    friction.median = (*prior)[0];
    friction.spread = (*prior)[1];
    if (friction.median < kFrictions.low || friction.spread > kPriorSpread.high) {
      section.fail("friction_prior", "has a median below 0.1 or a spread above 3",
                   "friction_prior = [1.0, 0.5]");
    }
  }
  friction.memory = section.flag("memory").value_or(friction.memory);
}

void read_solver(TomlSection section, Scene& scene) {
  scene.parity_tolerance_counts = section.number("parity_tolerance_counts", kParityToleranceCounts);
  scene.baseline_time_s = section.number("baseline_time_s", kBaselineTimeS);
  scene.estimator = read_name(section, "estimator", kEstimators);
  scene.angles = section.flag("angles").value_or(scene.angles);
  scene.uncertainty = section.flag("uncertainty").value_or(scene.uncertainty);
  if (scene.uncertainty && scene.estimator == Estimator::paper) {
    section.fail("uncertainty", "comes with the paper's estimator, which has none",
                 R"(estimator = "direct" or "contact")");
  }
  read_friction(section, scene.friction);
  section.finish();
}

// The size of the skin

/// Rows and columns of pillars of a scene, not yet checked.
struct PillarCounts {
  double rows;
  double cols;
};

/// Sets the size of the skin from `key`.
void set_size(const TomlSection& section, std::string_view key, PillarCounts counts, Skin& skin) {
  const Range allowed = {1, kMaxPillars};
  const bool fits = 4 * counts.rows * counts.cols <= double{kMaxSkinSensels};
  if (!allowed.contains(counts.rows) || !allowed.contains(counts.cols) || !fits) {
    section.fail(key,
                 fmt::format("means {} x {} {}", counts.rows, counts.cols, name_of(skin.layout)),
                 fmt::format("1 to {} each way, {} in all", kMaxPillars, kMaxSkinSensels / 4));
  }
  const std::uint32_t side = skin.has_pillars() ? 2 : 1;
  skin.rows = side * static_cast<std::uint32_t>(counts.rows);
  skin.cols = side * static_cast<std::uint32_t>(counts.cols);
}

/// Number of whole pillars along a length, tolerant of rounding.
double pillars_along(double length_mm, const Skin& skin) {
  return std::floor(length_mm / skin.element_pitch_mm().col_mm + 1e-9);
}

void read_size(TomlSection& section, Skin& skin) {
  const auto size_mm = section.numbers("size_mm", 2, {0, 1e8, true});
  const std::string_view elements = name_of(skin.layout);
  const std::string_view other = skin.has_pillars() ? "sensels" : "pillars";
  if (section.has(other)) {
    section.fail(other, fmt::format("does not go with the layout {}", elements),
                 fmt::format("{} = [rows, columns]", elements));
  }
  const auto counted = section.numbers(elements, 2, {1, kMaxPillars});
  if (size_mm && counted) section.fail(elements, "comes with size_mm", "one of the two");
  if (size_mm) {
    const PillarCounts counts = {pillars_along(size_mm->back(), skin),
                                 pillars_along(size_mm->front(), skin)};
    set_size(section, "size_mm", counts, skin);
    return;
  }
  if (!counted) {
    section.fail_missing("size_mm",
                         fmt::format("size_mm = [x, y] or {} = [rows, columns]", elements));
  }
  const PillarCounts counts = {counted->front(), counted->back()};
  if (counts.rows != std::floor(counts.rows) || counts.cols != std::floor(counts.cols)) {
    section.fail(elements, "has a fraction", "whole numbers, [rows, columns]");
  }
  set_size(section, elements, counts, skin);
}

// [direction_sweep] and [skin]

/// Reads the factor of a sweep, 1 unless given.
FactorKey read_factor(TomlSection& section) {
  return {0, section.number("factor", kSweepFactor).value_or(1)};
}

/// Reads a direction sweep and sets the skin's size: one pillar per force.
DirectionSweep read_direction_sweep(TomlSection section, Skin& skin) {
  DirectionSweep sweep;
  if (const auto count = section.whole_number("directions", 1, kMaxPillars)) {
    sweep.directions = static_cast<std::uint32_t>(*count);
  }
  if (const auto count = section.whole_number("inclinations", 1, kMaxPillars)) {
    sweep.inclinations = static_cast<std::uint32_t>(*count);
  }
  sweep.max_theta_deg = section.number("max_theta_deg", kMaxThetaDeg).value_or(sweep.max_theta_deg);
  if (const auto magnitudes = section.numbers("magnitudes_n", 0, kMagnitudeN)) {
    sweep.magnitudes_n = *magnitudes;
  }
  sweep.path = read_path<FactorKey>(section, "path of [direction_sweep]", {"factor"}, read_factor);
  section.finish();
  const PillarCounts counts = {static_cast<double>(pillar_rows(sweep)),
                               static_cast<double>(sweep.directions)};
  set_size(section, "inclinations", counts, skin);
  return sweep;
}

void read_skin(TomlSection section, Scene& scene) {
  read_quantities(section, kSkinQuantities, scene.skin);
  if (const auto pitch_mm = section.number("sensel_pitch_mm", kPitchMm)) {
    scene.skin.sensel_pitch_mm = *pitch_mm;
  }
  scene.modulus_kpa = section.number("modulus_kpa", kModulusKpa).value_or(scene.modulus_kpa);
  if (!std::holds_alternative<DirectionSweep>(scene.load)) read_size(section, scene.skin);
  for (const std::string_view key : {"size_mm", "pillars"}) {
    if (!std::holds_alternative<DirectionSweep>(scene.load) || !section.has(key)) continue;
    section.fail(key, "comes with [direction_sweep]", "no size: the sweep sets it");
  }
  section.finish();
}

// [[contact]]

/// A shape and a motion as in the file.
std::string name_of(ContactShape shape, ContactMotion motion) {
  return fmt::format(R"(shape = "{}", motion = "{}")",
                     kShapes[static_cast<std::size_t>(shape)].name,
                     kMotions[static_cast<std::size_t>(motion)].name);
}

void read_shape(TomlSection& section, ClosedFormContact& contact) {
  const auto shape = read_name(section, "shape", kShapes);
  if (!shape) section.fail_missing("shape", quoted(kShapes));
  contact.shape = *shape;
}

void read_motion(TomlSection& section, ClosedFormContact& contact) {
  std::vector<Named<ContactMotion>> possible;
  for (const auto& motion : kMotions) {
    if (is_possible(contact.shape, motion.value)) possible.push_back(motion);
  }
  const auto motion = read_name(section, "motion", kMotions);
  if (!motion) section.fail_missing("motion", quoted(possible));
  contact.motion = *motion;
  if (is_possible(contact.shape, contact.motion)) return;
  section.fail("motion", "does not go with the shape: " + name_of(contact.shape, contact.motion),
               quoted(possible));
}

/// Reads the numbers that apply to the shape and motion; refuses others.
void read_contact_quantities(TomlSection& section, ClosedFormContact& contact) {
  for (const auto& [quantity, required, applies] : kContactQuantities) {
    if (!applies(contact.shape, contact.motion)) {
      if (section.has(quantity.key)) {
        section.fail(quantity.key, "does not apply to " + name_of(contact.shape, contact.motion),
                     "no such key");
      }
      continue;
    }
    const auto value = section.number(quantity.key, quantity.range);
    if (!value && required) section.fail_missing(quantity.key, quantity.range.text());
    if (value) contact.*quantity.member = *value;
  }
}

/// Reads place and load of a contact, from a key of its path or from the contact itself.
ContactKey read_state(TomlSection& section) {
  const auto position = section.numbers("position_mm", 2, kPathPositionMm);
  if (!position) section.fail_missing("position_mm", "a list of 2, [x, y] in millimetres");
  const auto load = section.number("load_n", kPathLoadN);
  if (!load) section.fail_missing("load_n", kPathLoadN.text());
  return {0, position->front(), position->back(), *load};
}

/// Default reference load: the heaviest of the path.
double heaviest_load(const std::vector<ContactKey>& path) {
  const double heaviest = std::ranges::max(path, {}, &ContactKey::load_n).load_n;
  return heaviest > 0 ? heaviest : 1;
}

ClosedFormContact read_contact(TomlSection& section) {
  ClosedFormContact contact;
  read_shape(section, contact);
  read_motion(section, contact);
  read_contact_quantities(section, contact);
  if (contact.motion == ContactMotion::spin) {
    contact.clockwise = section.flag("clockwise").value_or(false);
  }
  contact.path =
      read_path<ContactKey>(section, "path of [[contact]]", {"position_mm", "load_n"}, read_state);
  if (!section.has("reference_load_n")) contact.reference_load_n = heaviest_load(contact.path);
  section.finish();
  return contact;
}

// The whole

/// Reads the load: a direction sweep, or any number of contacts and indenters. `folder` is the
/// folder of relative height map paths.
void read_load(TomlSection& root, const std::filesystem::path& folder, Scene& scene) {
  const char* const key = "direction_sweep";
  TomlSection sweep = root.table(key);
  auto contacts = root.tables("contact", "[[contact]]");
  const bool named_body = root.has("body");
  auto indenters =
      named_body ? root.tables("body", "[[body]]") : root.tables("indenter", "[[indenter]]");
  if (named_body) {
    scene.warnings.emplace_back(
        "[[body]] is now [[indenter]]; the former name works in this release only");
  }
  if (sweep.is_present() && contacts) root.fail(key, "comes with [[contact]]", "one of the two");
  if (sweep.is_present() && indenters) root.fail(key, "comes with [[indenter]]", "one of the two");
  if (sweep.is_present()) {
    scene.load = read_direction_sweep(std::move(sweep), scene.skin);
    return;
  }
  std::vector<ClosedFormContact> load;
  if (contacts) {
    for (TomlSection& contact : *contacts) load.push_back(read_contact(contact));
  }
  scene.load = std::move(load);
  if (!indenters) return;
  for (TomlSection& indenter : *indenters)
    scene.indenters.push_back(read_indenter(indenter, folder, scene.skin.layout));
}

Scene read_scene(TomlSection root, const std::filesystem::path& folder) {
  Scene scene;
  scene.title = root.text("title").value_or("");
  TomlSection skin = root.table("skin");
  // It decides which keys the load needs.
  if (const auto layout = read_name(skin, "layout", kLayouts)) scene.skin.layout = *layout;
  read_load(root, folder, scene);
  read_skin(std::move(skin), scene);
  read_sensor(root.table("sensor"), scene);
  read_surface(root.table("surface"), folder, scene);
  read_time(root.table("time"), scene);
  read_solver(root.table("solver"), scene);
  root.finish();
  return scene;
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& name) {
  check_key_depth(text, name);
  try {
    const toml::table table = toml::parse(text, name);
    Scene scene = read_scene(TomlSection(&table, "the scene", name),
                             std::filesystem::path(name).parent_path());
    scene.skin.stated = {true, true, true};
    check(scene, name.c_str());
    scene.text = text;
    scene.file = name;
    return scene;
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}:{}", name, error.source().begin.line),
                fmt::format("is not TOML: {}", error.description()),
                "mend the line, or see docs/scenes.md for an example");
  }
}

Scene load_scene(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 16 << 20;
  return parse_scene(InputFile(path, kMaxBytes).text(), path.string());
}

}  // namespace pillarfield
