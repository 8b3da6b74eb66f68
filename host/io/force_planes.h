#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/component_ends.h"
#include "pillarfield/force_file.h"
#include "solve/result_planes.h"

namespace pillarfield {

/// The planes of a file, status apart: first shear_x, shear_y and normal, which every file has.
[[nodiscard]] std::vector<ResultPlane> planes_of(const ForceFileInfo& info);

/// The values of the planes of a frame.
class FramePlanes {
 public:
  explicit FramePlanes(const ForceFileInfo& info);

  /// Computes the ends of components where the file has them. `forces` must live as long as its
  /// planes are asked for.
  void take(const ForceFieldView& forces);
  [[nodiscard]] std::span<const float> of(const ResultPlane& plane) const;

 private:
  bool uncertainty_;
  std::optional<double> direct_point_;
  ForceFieldView forces_;
  std::array<std::vector<float>, kComponentEnds> ends_;
};

}  // namespace pillarfield
