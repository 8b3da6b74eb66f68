#include <cmath>
#include <numbers>
#include <utility>

#include "simulation/scene/scene_limits.h"
#include "simulation/scene/scene_sections.h"

namespace pillarfield {
namespace {

CurvatureKey read_curvature(TomlSection& section) {
  const auto curvature = section.numbers("curvature_per_mm", 3, kCurvaturePerMm);
  if (!curvature) section.fail_missing("curvature_per_mm", "a list of 3, [x, y, xy], each 1/mm");
  return {0, (*curvature)[0], (*curvature)[1], (*curvature)[2]};
}

/// Curvature of a sheet on a plane, a cylinder or a sphere.
CurvatureKey curvature_of(const Surface& surface) {
  if (surface.shape == SurfaceShape::plane) return {};
  const double per_mm = 1 / surface.radius_mm;
  if (surface.shape == SurfaceShape::sphere) return {0, per_mm, per_mm, 0};
  const double axis = surface.axis_deg * std::numbers::pi / 180;
  const double sine = std::sin(axis);
  const double cosine = std::cos(axis);
  return {0, per_mm * sine * sine, per_mm * cosine * cosine, -2 * per_mm * sine * cosine};
}

/// Reads how the skin bends: its curvature, or that of its surface.
void read_bending(TomlSection& section, Scene& scene) {
  const auto spread = section.number("bend_spread_counts_mm", kBendSpread);
  const bool has_curvature = section.has("curvature_per_mm") || section.has("path");
  if (!spread && !has_curvature) return;
  Bending bending;
  bending.spread_counts_mm = spread.value_or(bending.spread_counts_mm);
  if (!has_curvature && scene.skin.surface) {
    bending.path = {curvature_of(*scene.skin.surface)};
  } else {
    bending.path =
        read_path<CurvatureKey>(section, "path of [surface]", {"curvature_per_mm"}, read_curvature);
  }
  scene.bending = std::move(bending);
}

SurfaceMap read_surface_map(TomlSection& section, const std::filesystem::path& folder) {
  SurfaceMap map;
  map.path = read_height_map_path(section, folder);
  const auto size = section.numbers("height_map_size_mm", 2, kIndenterSizeMm);
  if (!size) section.fail_missing("height_map_size_mm", "a list of 2, [x, y] in millimetres");
  map.size_mm = {(*size)[0], (*size)[1]};
  const auto depth = section.number("height_map_depth_mm", kIndenterSizeMm);
  if (!depth) section.fail_missing("height_map_depth_mm", kIndenterSizeMm.text());
  map.depth_mm = *depth;
  return map;
}

void read_surface_shape(TomlSection& section, const std::filesystem::path& folder, Scene& scene) {
  const auto shape = read_name(section, "shape", kSurfaceShapes);
  if (!shape) return;
  if (*shape == SurfaceShape::height_map) {
    scene.surface_map = read_surface_map(section, folder);
    return;
  }
  Surface surface;
  surface.shape = *shape;
  if (*shape != SurfaceShape::plane) {
    const auto radius = section.number("radius_mm", kSurfaceRadiusMm);
    if (!radius) section.fail_missing("radius_mm", kSurfaceRadiusMm.text());
    surface.radius_mm = *radius;
  }
  if (*shape == SurfaceShape::cylinder) {
    surface.axis_deg = section.number("axis_deg", kSurfaceAxisDeg).value_or(surface.axis_deg);
  }
  scene.skin.surface = surface;
}

}  // namespace

void read_surface(TomlSection section, const std::filesystem::path& folder, Scene& scene) {
  if (!section.is_present()) return;
  read_surface_shape(section, folder, scene);
  read_bending(section, scene);
  section.finish();
}

}  // namespace pillarfield
