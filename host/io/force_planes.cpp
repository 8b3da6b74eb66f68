#include "io/force_planes.h"

#include <array>

#include "pillarfield/solver_plan.h"

namespace pillarfield {
namespace {

constexpr const char* kForce = "force";
constexpr const char* kUncertainty = "uncertainty";

}  // namespace

std::string ForcePlane::field() const { return group == kForce ? name : group + "_" + name; }

bool ForcePlane::is_end_of_component() const {
  return group == kUncertainty && index >= kUncertaintyPlanes;
}

std::span<const float> solved_values(const ForcePlane& plane, const ForceFieldView& forces) {
  if (plane.is_end_of_component()) return {};
  if (plane.group == kUncertainty) return forces.uncertainty[static_cast<Uncertainty>(plane.index)];
  const std::array planes = {forces.shear_x,   forces.shear_y, forces.normal,
                             forces.magnitude, forces.theta,   forces.phi};
  return planes.at(plane.index);
}

FramePlanes::FramePlanes(const ForceFileInfo& info) : uncertainty_(info.uncertainty) {
  if (info.estimator == name_of(Estimator::direct)) direct_point_ = info.segment_point;
}

void FramePlanes::take(const ForceFieldView& forces) {
  forces_ = forces;
  if (!uncertainty_) return;
  for (auto& plane : ends_) plane.resize(forces.normal.size());
  for (std::size_t pillar = 0; pillar < forces.normal.size(); ++pillar) {
    const auto ends = component_ends(forces, pillar, direct_point_);
    for (std::size_t i = 0; i < kComponentEnds; ++i) ends_[i][pillar] = ends[i];
  }
}

std::span<const float> FramePlanes::of(const ForcePlane& plane) const {
  if (plane.is_end_of_component()) return ends_.at(plane.index - kUncertaintyPlanes);
  return solved_values(plane, forces_);
}

std::vector<ForcePlane> component_planes() {
  return {{kForce, "shear_x", "n", 0}, {kForce, "shear_y", "n", 1}, {kForce, "normal", "n", 2}};
}

std::vector<ForcePlane> further_planes(const ForceFileInfo& info) {
  std::vector<ForcePlane> planes;
  if (info.angles) {
    planes = {
        {kForce, "magnitude", "n", 3}, {kForce, "theta", "rad", 4}, {kForce, "phi", "rad", 5}};
  }
  if (!info.uncertainty) return planes;
  for (std::size_t index = 0; index < kUncertaintyPlanes; ++index) {
    const std::string name = name_of(static_cast<Uncertainty>(index));
    const bool angle = name.starts_with("theta") || name.starts_with("phi");
    planes.push_back({kUncertainty, name, angle ? "rad" : "n", index});
  }
  for (std::size_t i = 0; i < kComponentEnds; ++i) {
    planes.push_back(
        {kUncertainty, name_of(static_cast<ComponentEnd>(i)), "n", kUncertaintyPlanes + i});
  }
  return planes;
}

std::vector<ForcePlane> all_planes(const ForceFileInfo& info) {
  std::vector<ForcePlane> planes = component_planes();
  for (ForcePlane& plane : further_planes(info)) planes.push_back(std::move(plane));
  return planes;
}

}  // namespace pillarfield
