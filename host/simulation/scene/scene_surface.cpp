#include <cmath>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/scene.h"
#include "simulation/indenter/indenter_surface.h"

namespace pillarfield {
namespace {

/// The relief that an indenter of this height map has; its depth below the highest point.
std::unique_ptr<Relief> relief_of(const SurfaceMap& map) {
  Indenter indenter;
  indenter.shape = IndenterShape::height_map;
  indenter.height_map = map.path;
  indenter.height_map_size_mm = map.size_mm;
  indenter.height_map_depth_mm = map.depth_mm;
  return make_relief(indenter);
}

}  // namespace

std::optional<Surface> surface_of(const Scene& scene) {
  if (!scene.surface_map) return scene.skin.surface;
  const SurfaceMap& map = *scene.surface_map;
  const auto relief = relief_of(map);
  Surface surface;
  surface.shape = SurfaceShape::height_map;
  for (const Pose& pillar : poses_of({}, scene.skin.element_grid())) {
    const double depth_mm = relief->height_mm(pillar.position_mm.x, pillar.position_mm.y);
    if (!std::isfinite(depth_mm)) {
      throw Error(map.path.string(), "does not cover the skin", "give a larger height_map_size_mm");
    }
    surface.heights_mm.push_back(static_cast<float>(map.depth_mm - depth_mm));
  }
  return surface;
}

void set_skin(Skin& skin, const Scene& scene) {
  skin.layout = scene.skin.layout;
  skin.sensel_pitch_mm = scene.skin.sensel_pitch_mm;
  skin.counts_per_newton = scene.skin.counts_per_newton;
  skin.threshold_counts = scene.skin.threshold_counts;
  skin.full_scale_counts = scene.skin.full_scale_counts;
  skin.power_law = scene.skin.power_law;
  skin.stated = {true, true, true};
  if (auto surface = surface_of(scene)) skin.surface = std::move(surface);
}

void set_solver(SolverPlan& plan, const Scene& scene) {
  apply(scene.solver, plan);
  plan.frame_interval_s = 1 / scene.rate_hz;
  if (scene.solver.baseline_time_s) set_baseline(plan, *scene.solver.baseline_time_s);
  if (scene.sensor.noise_counts > 0) plan.noise_counts = scene.sensor.noise_counts;
}

}  // namespace pillarfield
