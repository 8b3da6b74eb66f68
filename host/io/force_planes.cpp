#include "io/force_planes.h"

#include <algorithm>
#include <iterator>

#include "pillarfield/pressure_unit.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

std::vector<ResultPlane> planes_of(const ForceFileInfo& info) {
  std::vector<ResultPlane> planes;
  std::ranges::copy_if(kResultPlanes, std::back_inserter(planes), [&](const ResultPlane& plane) {
    if (plane.set == PlaneSet::pressure) return info.pressure;
    return has_plane(info.layout, info.angles, info.uncertainty, plane);
  });
  return planes;
}

FramePlanes::FramePlanes(const ForceFileInfo& info)
    : planes_(planes_of(info)),
      has_ends_(info.uncertainty),
      kpa_per_newton_(info.pressure ? kpa_per_newton(info.element_pitch_mm) : 0),
      coefficient_(info.effects.shear_coefficient.value_or(ShearCoefficient{})) {
  if (info.estimator == name_of(Estimator::direct)) direct_point_ = info.segment_point;
}

void FramePlanes::set_frame(const ForceFieldView& forces) {
  forces_ = forces;
  if (kpa_per_newton_ > 0) {
    pressure_.resize(forces.normal.size());
    std::ranges::transform(forces.normal, pressure_.begin(),
                           [this](float newtons) { return newtons * kpa_per_newton_; });
  }
  if (!has_ends_) return;
  for (auto& plane : ends_) plane.resize(forces.normal.size());
  for (std::size_t pillar = 0; pillar < forces.normal.size(); ++pillar) {
    const auto ends = component_ends(forces, pillar, direct_point_, coefficient_);
    for (std::size_t i = 0; i < kComponentEnds; ++i) ends_[i][pillar] = ends[i];
  }
}

std::span<const float> FramePlanes::of(const ResultPlane& plane) const {
  if (plane.set == PlaneSet::pressure) return pressure_;
  if (plane.index >= kSolvedPlanes) return ends_.at(plane.index - kSolvedPlanes);
  return plane_of(forces_, plane.index);
}

}  // namespace pillarfield
