#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "kernels/frame/result_planes.h"
#include "pillarfield/component_ends.h"
#include "pillarfield/force_field.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Planes that a plan requests together, or a file holds together.
enum class PlaneSet : std::uint8_t { forces, angles, uncertainty, component_ends, pressure };

/// A plane of floats of a result, with its name in files.
struct ResultPlane {
  PlaneSet set;
  const char* name;   ///< "shear_x", "theta_low", ...
  const char* unit;   ///< "n", "rad" or "kpa"
  std::size_t index;  ///< in kResultPlanes

  /// "force" or "uncertainty": its group in files with groups.
  [[nodiscard]] const char* group() const;
  /// "shear_x", "uncertainty_theta_low": its name in files without groups.
  [[nodiscard]] std::string field() const;
};

/// The planes of a solve in memory order, without status; then those that only files have.
inline constexpr auto kResultPlanes = [] {
  std::array planes = {
#define PF_PLANE(name, unit, value) ResultPlane{PlaneSet::forces, #name, #unit, 0},
      PF_FORCE_PLANES(PF_PLANE)
#undef PF_PLANE
#define PF_PLANE(name, unit, value) ResultPlane{PlaneSet::angles, #name, #unit, 0},
          PF_ANGLE_PLANES(PF_PLANE)
#undef PF_PLANE
#define PF_PLANE(name, unit, value) ResultPlane{PlaneSet::uncertainty, #name, #unit, 0},
              PF_UNCERTAINTY_PLANES(PF_PLANE)
#undef PF_PLANE
                  ResultPlane{PlaneSet::component_ends, "shear_x_low", "n", 0},
      ResultPlane{PlaneSet::component_ends, "shear_x_high", "n", 0},
      ResultPlane{PlaneSet::component_ends, "shear_y_low", "n", 0},
      ResultPlane{PlaneSet::component_ends, "shear_y_high", "n", 0},
      ResultPlane{PlaneSet::component_ends, "normal_low", "n", 0},
      ResultPlane{PlaneSet::component_ends, "normal_high", "n", 0},
      ResultPlane{PlaneSet::pressure, "pressure", "kpa", 0},
  };
  for (std::size_t i = 0; i < planes.size(); ++i) planes[i].index = i;
  return planes;
}();

inline constexpr std::size_t kSolvedPlanes = kResultPlanes.size() - kComponentEnds - 1;
inline constexpr std::size_t kNamedPlanes = kSolvedPlanes - kUncertaintyPlanes;
inline constexpr std::size_t kForcePlanes = 3;

/// True if a plan or file with these options has a plane other than pressure. Without pillars only
/// normal force, its deviation and the ends of its interval exist.
constexpr bool has_plane(SkinLayout layout, bool angles, bool uncertainty,
                         const ResultPlane& plane) {
  if (layout == SkinLayout::sensels && !std::string_view(plane.name).starts_with("normal"))
    return false;
  if (plane.set == PlaneSet::pressure) return false;
  return plane.set == PlaneSet::forces || (plane.set == PlaneSet::angles ? angles : uncertainty);
}

/// One of the first kSolvedPlanes of a FieldView or FieldPlanes.
template <class Field>
auto& plane_of(Field& field, std::size_t index) {
#define PF_PLANE(name, unit, value) &Field::name,
  constexpr std::array kNamed = {PF_FORCE_PLANES(PF_PLANE) PF_ANGLE_PLANES(PF_PLANE)};
#undef PF_PLANE
  if (index < kNamed.size()) return field.*kNamed[index];
  return field.uncertainty[static_cast<Uncertainty>(index - kNamed.size())];
}

}  // namespace pillarfield
