#include "contacts/contact_wrench.h"

#include <cmath>

#include "skin/vectors.h"

namespace pillarfield {

Wrench wrench_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                 std::span<const Pose> poses) {
  Wrench wrench;
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::size_t pillar = std::size_t{run.row} * forces.cols + col;
      const Pose& pose = poses[pillar];
      const auto of = [&](std::span<const float> plane) {
        return plane.empty() ? 0 : finite_or_zero(plane[pillar]);
      };
      const Vector3 force_n =
          rotated(pose, {of(forces.shear_x), of(forces.shear_y), -of(forces.normal)});
      add(wrench, {force_n, cross(pose.position_mm, force_n)});
    }
  }
  return wrench;
}

void add(Wrench& sum, const Wrench& wrench) {
  sum.force_n = sum.force_n + wrench.force_n;
  sum.moment_nmm = sum.moment_nmm + wrench.moment_nmm;
}

}  // namespace pillarfield
