#pragma once

#include <span>
#include <string>
#include <vector>

#include "pillarfield/force_file.h"

namespace pillarfield {

/// A plane of floats of a force field as files name it.
struct ForcePlane {
  std::string group;  ///< "force" or "uncertainty"
  std::string name;   ///< "shear_x", "theta_low", ...
  std::string unit;   ///< "n" or "rad"
  std::size_t index;  ///< in its group

  /// "shear_x", "uncertainty_theta_low": where there are no groups.
  [[nodiscard]] std::string field() const;
  [[nodiscard]] std::span<const float> values(const ForceFieldView& forces) const;
};

/// shear_x, shear_y and normal, which every file has.
[[nodiscard]] std::vector<ForcePlane> component_planes();

/// The planes that a file has beside them and the status.
[[nodiscard]] std::vector<ForcePlane> further_planes(const ForceFileInfo& info);

/// All of them, the components first.
[[nodiscard]] std::vector<ForcePlane> all_planes(const ForceFileInfo& info);

}  // namespace pillarfield
