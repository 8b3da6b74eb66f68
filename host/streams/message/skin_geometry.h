#pragma once

#include <vector>

#include "pillarfield/contact_quantities.h"
#include "pillarfield/live.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Places and directions of the pillars of a skin, flat if its surface is unknown.
class SkinGeometry {
 public:
  explicit SkinGeometry(const LiveSinkInfo& info);

  /// Of all pillars, row by row.
  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }

  /// Of a point of the skin; on a height map that of the nearest pillar.
  [[nodiscard]] Pose pose_of(const PatchPlace& place) const;

 private:
  Surface surface_;
  PillarLayout layout_;
  std::vector<Pose> poses_;
};

/// Force on the skin in the body's frame, N; `pose` is that of its place.
[[nodiscard]] Vector3 force_of(const ContactQuantities& contact, const Pose& pose);

}  // namespace pillarfield
