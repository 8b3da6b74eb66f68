#include "streams/message/skin_geometry.h"

#include <algorithm>
#include <cmath>

#include "skin/vectors.h"

namespace pillarfield {
namespace {

/// The index of the pillar nearest to `offset_mm` from the first one.
std::size_t nearest_pillar(double offset_mm, double pitch_mm, std::uint32_t pillars) {
  const double index = std::round(offset_mm / pitch_mm);
  return static_cast<std::size_t>(std::clamp(index, 0.0, static_cast<double>(pillars - 1)));
}

}  // namespace

SkinGeometry::SkinGeometry(const LiveSinkInfo& info)
    : surface_(info.forces.surface.value_or(Surface{})),
      layout_{info.forces.rows, info.forces.cols, info.forces.pillar_pitch_mm},
      poses_(poses_of(surface_, layout_)) {}

Pose SkinGeometry::pose_of(const PatchPlace& place) const {
  if (surface_.shape != SurfaceShape::height_map) {
    return pose_at(surface_, place.x_mm, place.y_mm);
  }
  const double left_mm = -0.5 * (layout_.cols - 1) * layout_.pitch_mm;
  const double top_mm = 0.5 * (layout_.rows - 1) * layout_.pitch_mm;
  const std::size_t row = nearest_pillar(top_mm - place.y_mm, layout_.pitch_mm, layout_.rows);
  const std::size_t col = nearest_pillar(place.x_mm - left_mm, layout_.pitch_mm, layout_.cols);
  return poses_[row * layout_.cols + col];
}

Vector3 force_of(const ContactQuantities& contact, const Pose& pose) {
  if (contact.wrench) return contact.wrench->force_n;
  return contact.shear_x_n * pose.tangent_x + contact.shear_y_n * pose.tangent_y -
         contact.normal_n * pose.normal;
}

}  // namespace pillarfield
