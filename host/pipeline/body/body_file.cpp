#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <set>

#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/simulator.h"
#include "pillarfield/whole_body.h"
#include "simulation/scene/toml_depth.h"
#include "simulation/scene/toml_section.h"
#include "skin/vectors.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kMostBodySensels = std::uint64_t{1} << 24;  ///< nearly 7 m²
constexpr Range kBodyRateHz = {1, 1e5};
constexpr Range kBodyRefreshS = {1e-3, 3600};
constexpr Range kBodyPlaceMm = {-1e5, 1e5};
constexpr Range kBodyDirection = {-1e6, 1e6};
constexpr Range kClockOffsetS = {-1e6, 1e6};
constexpr Range kClockDriftPpm = {-1000, 1000};

Vector3 read_vector(TomlSection& section, std::string_view key, const Range& range,
                    const Vector3& otherwise) {
  const auto values = section.numbers(key, 3, range);
  return values ? Vector3{(*values)[0], (*values)[1], (*values)[2]} : otherwise;
}

/// Directions of any length; tangent_y is turned until it is perpendicular, if it nearly is.
Pose read_pose(TomlSection& section) {
  constexpr double kMostCosine = 0.01;
  Pose pose;
  pose.position_mm = read_vector(section, "origin_mm", kBodyPlaceMm, {});
  const Vector3 x = read_vector(section, "tangent_x", kBodyDirection, {1, 0, 0});
  const Vector3 y = read_vector(section, "tangent_y", kBodyDirection, {0, 1, 0});
  const double lengths = std::sqrt(dot(x, x) * dot(y, y));
  if (!(lengths > 1e-6) || std::abs(dot(x, y)) > kMostCosine * lengths) {
    section.fail("tangent_y", "is not perpendicular to tangent_x",
                 "directions on the skin, 90 degrees apart");
  }
  pose.tangent_x = unit(x);
  pose.normal = unit(cross(x, y));
  pose.tangent_y = cross(pose.normal, pose.tangent_x);
  return pose;
}

/// Gives the skin of a scene another size.
void read_size(TomlSection& section, Scene& scene) {
  // A packet is refused beyond 2^24 sensels.
  const Range side_mm = {scene.skin.pillar_pitch_mm(), 4096 * scene.skin.sensel_pitch_mm};
  const auto size_mm = section.numbers("size_mm", 2, side_mm);
  if (!size_mm) return;
  const auto sensels = [&](double mm) {
    return 2 * static_cast<std::uint32_t>(std::llround(mm / scene.skin.pillar_pitch_mm()));
  };
  scene.skin.cols = sensels(size_mm->front());
  scene.skin.rows = sensels(size_mm->back());
}

SolverPlan plan_of_patch(const Simulator& simulator) {
  SolverPlan plan;
  plan.skin = simulator.scene().skin;
  if (auto surface = surface_of(simulator.scene())) plan.skin.surface = std::move(surface);
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, simulator.scene());
  plan.frame_interval_s = 1 / simulator.scene().rate_hz;
  return plan;
}

/// Throws Error if the body, with a patch of this scene, has more than kMostBodySensels: a short
/// file may describe a thousand large patches.
void require_size(TomlSection& section, const BodyFile& body, const Scene& scene) {
  std::uint64_t sensels = scene.skin.sensels();
  for (const BodyFile::Simulated& other : body.simulated) sensels += other.scene.skin.sensels();
  if (sensels <= kMostBodySensels) return;
  section.fail("size_mm", fmt::format("makes a body of {} sensels", sensels),
               fmt::format("at most {} in all patches", kMostBodySensels));
}

void read_patch(TomlSection& section, const std::filesystem::path& folder, BodyFile& body) {
  BodyPatch patch;
  const auto name = section.text("name");
  if (!name || name->empty()) section.fail_missing("name", "a text in quotes, different for each");
  patch.name = *name;
  const auto scene_file = section.text("scene");
  if (!scene_file) section.fail_missing("scene", "the file of a scene: skin, sensor and solver");
  BodyFile::Simulated simulated;
  simulated.scene = load_scene(folder / *scene_file);
  simulated.scene.rate_hz = body.skin.rate_hz;
  read_size(section, simulated.scene);
  require_size(section, body, simulated.scene);
  if (const auto seed = section.whole_number("seed", 0, INT64_MAX)) {
    simulated.scene.seed = static_cast<std::uint64_t>(*seed);
  }
  simulated.clock_offset_s = section.number("clock_offset_s", kClockOffsetS).value_or(0);
  simulated.clock_drift_ppm = section.number("clock_drift_ppm", kClockDriftPpm).value_or(0);
  patch.pose = read_pose(section);
  const auto calibration = section.text("calibration");
  section.finish();
  patch.plan = plan_of_patch(Simulator(simulated.scene));
  if (calibration) {
    const auto path = folder / *calibration;
    const SkinCalibration measured = read_calibration_file(path);
    require_fitting(measured, patch.plan.skin, path.string());
    apply(measured, patch.plan.skin, patch.plan.calibration);
  }
  check(patch.plan, "patch " + patch.name);
  body.skin.patches.push_back(std::move(patch));
  body.simulated.push_back(std::move(simulated));
}

void refuse_repeated_names(const std::string& file, const BodySkin& skin) {
  std::set<std::string> names;
  for (const BodyPatch& patch : skin.patches) {
    if (names.insert(patch.name).second) continue;
    throw Error(file, fmt::format("two patches have the name \"{:.40}\"", patch.name),
                "give each a name of its own");
  }
}

BodyFile read_body(const toml::table& table, const std::filesystem::path& path) {
  const std::string file = path.string();
  TomlSection section(&table, "the body", file);
  BodyFile body;
  body.skin.title = section.text("title").value_or("");
  body.skin.rate_hz = section.number("rate_hz", kBodyRateHz).value_or(body.skin.rate_hz);
  body.skin.refresh_s = section.number("refresh_s", kBodyRefreshS).value_or(body.skin.refresh_s);
  auto patches = section.tables("patch", "[[patch]]");
  section.finish();
  if (!patches) section.fail_missing("patch", "a list of tables, [[patch]]");
  if (patches->size() > kMostPatches) {
    section.fail("patch", "has too many tables",
                 fmt::format("1 to {} tables, [[patch]]", kMostPatches));
  }
  for (TomlSection& patch : *patches) read_patch(patch, path.parent_path(), body);
  refuse_repeated_names(file, body.skin);
  return body;
}

}  // namespace

BodyFile parse_body(std::string_view text, const std::filesystem::path& name) {
  check_key_depth(text, name.string());
  try {
    return read_body(toml::parse(text, name.string()), name);
  } catch (const toml::parse_error& error) {
    throw Error(fmt::format("{}:{}", name.string(), error.source().begin.line),
                fmt::format("is not TOML: {}", error.description()),
                "mend the line, or see docs/whole_body.md for an example");
  }
}

BodyFile load_body(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMostBytes = 1 << 20;
  const Error unreadable(path.string(), "cannot be read as a body",
                         "name a TOML file of at most 1 MiB");
  // Check the size first: only regular files have one, and opening a pipe may block.
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) > kMostBytes || failed) throw unreadable;
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) throw unreadable;
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  return parse_body(text, path);
}

}  // namespace pillarfield
