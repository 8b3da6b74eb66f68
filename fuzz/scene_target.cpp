#include <algorithm>

#include "fuzz/targets.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"

namespace pillarfield::fuzz {
namespace {

/// Largest simulated scene, in sensels and in sensels times contacts.
constexpr std::uint64_t kMaxSceneSensels = 1 << 12;
constexpr std::uint64_t kMaxSceneWork = 1 << 14;

/// Whether an indenter's contact has few pillars and few steps, and its shape is not in a file.
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
