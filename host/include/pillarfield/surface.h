#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "pillarfield/pitch.h"

namespace pillarfield {

/// A vector in the body's frame.
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
};

/// Place and directions of a point of the skin in the body's frame: unit vectors, right-handed
/// (tangent_x × tangent_y = normal).
struct Pose {
  Vector3 position_mm;
  Vector3 tangent_x;  ///< + right on the skin
  Vector3 tangent_y;  ///< + up on the skin
  Vector3 normal;     ///< outwards
};

enum class SurfaceShape : std::uint8_t { plane, cylinder, sphere, height_map };

/// "plane", "cylinder", "sphere" or "height_map".
[[nodiscard]] const char* name_of(SurfaceShape shape);

/// The surface that the skin covers (docs/derivations/surface.md). The body's frame has its origin
/// at the middle of the skin, where x points right, y up and z outwards; on a height map z = 0 is
/// the plane from which heights count.
///
/// The skin is a sheet that bends without stretching: onto a cylinder exactly, onto a sphere along
/// the great circles through its middle. On a height map each pillar keeps its x and y.
struct Surface {
  SurfaceShape shape = SurfaceShape::plane;
  /// Radius of cylinder or sphere, mm, |radius| 1 to 1e6. Positive: the skin is on the outside.
  double radius_mm = 0;
  double axis_deg = 90;  ///< cylinder: direction of the axis on the skin, from +x towards +y
  std::vector<float> heights_mm;  ///< height map: of each pillar, [pillar rows, cols], ± 1e4 mm
};

/// The pillars of a skin.
struct ElementGrid {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  Pitch pitch_mm;
};

/// Throws Error, naming `where`, if a member is out of range, heights are not one a pillar, or the
/// pillars cover more than a whole turn of the cylinder or half of the sphere.
void check(const Surface& surface, const ElementGrid& pillars, std::string_view where);

/// Poses of all pillars, row by row. The surface must fit the pillars.
[[nodiscard]] std::vector<Pose> poses_of(const Surface& surface, const ElementGrid& pillars);

/// Pose of a point of the skin, mm from its middle; not for a height map.
[[nodiscard]] Pose pose_at(const Surface& surface, double x_mm, double y_mm);

}  // namespace pillarfield
