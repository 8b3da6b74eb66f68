#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/component_ends.h"
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
  /// Whether it is one of ComponentEnd, which follow from the other planes.
  [[nodiscard]] bool is_end_of_component() const;
};

/// The values of the planes of a frame.
class FramePlanes {
 public:
  explicit FramePlanes(const ForceFileInfo& info);

  /// Computes the ends of components where the file has them. `forces` must live as long as its
  /// planes are asked for.
  void take(const ForceFieldView& forces);
  [[nodiscard]] std::span<const float> of(const ForcePlane& plane) const;

 private:
  bool uncertainty_;
  std::optional<double> direct_point_;
  ForceFieldView forces_;
  std::array<std::vector<float>, kComponentEnds> ends_;
};

/// Empty where a frame lacks it, and for the ends of components.
[[nodiscard]] std::span<const float> solved_values(const ForcePlane& plane,
                                                   const ForceFieldView& forces);

/// shear_x, shear_y and normal, which every file has.
[[nodiscard]] std::vector<ForcePlane> component_planes();

/// The planes that a file has beside them and the status.
[[nodiscard]] std::vector<ForcePlane> further_planes(const ForceFileInfo& info);

/// All of them, the components first.
[[nodiscard]] std::vector<ForcePlane> all_planes(const ForceFileInfo& info);

}  // namespace pillarfield
