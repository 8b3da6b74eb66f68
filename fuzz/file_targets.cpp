// The readers of files.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "fuzz/targets.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/comparison.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/recording.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::fuzz {
namespace {

/// Indices of the first, the last and some other frames of a file that claims `frames`.
std::set<std::uint64_t> some_frames(std::uint64_t frames) {
  if (frames == 0) return {};
  const std::uint64_t last = frames - 1;
  return {0, last / 2, last / 2 + last / 4, last == 0 ? 0 : last - 1, last};
}

/// Largest frame that is solved, in sensels.
constexpr std::uint64_t kMaxSolved = 1 << 14;

SolverPlan plan_of_source(const FrameSource& source) {
  SolverPlan plan;
  plan.skin = source.skin();
  plan.sensel_type = source.sensel_type();
  plan.calibration = source.calibration();
  return plan;
}

/// Largest simulated scene, in sensels and in sensels times contacts.
constexpr std::uint64_t kMaxSceneSensels = 1 << 12;
constexpr std::uint64_t kMaxSceneWork = 1 << 14;

/// True if an indenter's contact has few pillars and few steps, and its shape is not in a file.
bool is_small(const Indenter& indenter, const Scene& scene) {
  constexpr double kMaxPillars = 8;
  constexpr double kMaxSteps = 2;
  const double most_mm = kMaxPillars * scene.skin.pillar_pitch_mm();
  const double reach_mm =
      std::max({indenter.radius_mm, indenter.radii_mm[0], indenter.radii_mm[1],
                indenter.shape == IndenterShape::cylinder ? indenter.length_mm : 0});
  const double steps = indenter.path.back().time_s * scene.rate_hz * indenter.substeps;
  return indenter.shape != IndenterShape::height_map && reach_mm <= most_mm && steps <= kMaxSteps;
}

bool is_small(const Scene& scene) {
  if (scene.indenters.size() > 1) return false;
  if (!scene.indenters.empty() && !is_small(scene.indenters.front(), scene)) return false;
  const auto* const contacts = std::get_if<std::vector<ClosedFormContact>>(&scene.load);
  const std::uint64_t each = contacts == nullptr ? 1 : contacts->size();
  return scene.skin.sensels() <= kMaxSceneSensels && scene.skin.sensels() * each <= kMaxSceneWork;
}

}  // namespace

void read_plain(const std::filesystem::path& path, const ReadOptions& options) {
  ReadOptions untimed = options;
  untimed.untimed = true;
  ReadOptions lines = untimed;
  lines.frame_size = FrameSize{4, 6};
  ReadOptions named = untimed;
  named.dataset = "raw";
  std::string failure;
  for (const ReadOptions& each : {untimed, lines, named}) {
    try {
      read_frames(path, each);
      return;
    } catch (const Error& error) {
      if (failure.empty()) failure = error.what();
    }
  }
  throw Error({}, failure);
}

void read_frames(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  const auto source = open_frames(path, options);
  const Skin& skin = source->skin();
  if (skin.sensels() > kMaxRead) return;
  const SolverPlan plan = plan_of_source(*source);
  check(plan, path.native());
  FrameBuffer frame(plan.sensel_type, skin.rows, skin.cols);
  ForceField truth(skin);
  ContactTracker tracker(skin.element_pitch_mm(), {.layout = skin.layout, .threads = 1});
  for (const std::uint64_t index : some_frames(source->frames())) {
    const double time_s = source->read(index, frame);
    if (source->has_truth()) source->read_truth(index, truth);
    if (skin.sensels() > kMaxSolved) continue;
    const double when_s = std::isfinite(time_s) ? time_s : static_cast<double>(index);
    tracker.update(solve_on_host(plan, frame.view()).view(), when_s);
  }
}

void read_forces(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  (void)is_force_file(path);
  const ForceFileReader reader(path, options);
  const ForceFileInfo& info = reader.info();
  if (std::uint64_t{info.rows} * info.cols > kMaxRead) return;
  ForceField forces(info.rows, info.cols);
  Comparison comparison;
  for (const std::uint64_t index : some_frames(reader.frames())) {
    reader.read(index, forces);
    if (info.contacts) (void)reader.read_contacts(index);
    comparison.add(forces.view(), forces.view());
  }
}

void read_calibration(const std::filesystem::path& path,
                      [[maybe_unused]] const ReadOptions& options) {
  (void)is_calibration_file(path);
  const SkinCalibration calibration = read_calibration_file(path, options);
  SolverPlan plan;
  plan.skin.rows = calibration.rows;
  plan.skin.cols = calibration.cols;
  apply(calibration, plan.skin, plan.calibration);
  check(plan, path.native());
}

void read_scene(const std::filesystem::path& path, const ReadOptions&) {
  const Scene scene = load_scene(path);
  if (!is_small(scene)) return;
  const Simulator simulator(scene);
  FrameBuffer raw(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
  ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
  simulator.render(0, raw, truth);
  if (scene.frames > 1) simulator.render(scene.frames - 1, raw, truth);
}

}  // namespace pillarfield::fuzz
