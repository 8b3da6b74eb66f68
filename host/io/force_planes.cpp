#include "io/force_planes.h"

#include <array>

namespace pillarfield {
namespace {

constexpr const char* kForce = "force";
constexpr const char* kUncertainty = "uncertainty";

}  // namespace

std::string ForcePlane::field() const { return group == kForce ? name : group + "_" + name; }

std::span<const float> ForcePlane::values(const ForceFieldView& forces) const {
  if (group == kUncertainty) return forces.uncertainty[static_cast<Uncertainty>(index)];
  const std::array planes = {forces.shear_x,   forces.shear_y, forces.normal,
                             forces.magnitude, forces.theta,   forces.phi};
  return planes.at(index);
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
  return planes;
}

std::vector<ForcePlane> all_planes(const ForceFileInfo& info) {
  std::vector<ForcePlane> planes = component_planes();
  for (ForcePlane& plane : further_planes(info)) planes.push_back(std::move(plane));
  return planes;
}

}  // namespace pillarfield
