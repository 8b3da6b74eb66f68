#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/component_ends.h"
#include "pillarfield/force_file.h"
#include "solve/result_planes.h"

namespace pillarfield {

/// The planes of a file without status; the first are shear_x, shear_y and normal, which every file
/// has.
[[nodiscard]] std::vector<ResultPlane> planes_of(const ForceFileInfo& info);

/// The planes of a file and their values in one frame.
class FramePlanes {
 public:
  explicit FramePlanes(const ForceFileInfo& info);

  /// planes_of() the file.
  [[nodiscard]] const std::vector<ResultPlane>& planes() const { return planes_; }

  /// Sets the frame; computes pressure and interval ends of components if the file has them.
  /// `forces` must outlive the calls of of().
  void set_frame(const ForceFieldView& forces);
  [[nodiscard]] std::span<const float> of(const ResultPlane& plane) const;

 private:
  std::vector<ResultPlane> planes_;
  bool has_ends_;
  float kpa_per_newton_;  // 0: the file has no pressure
  std::optional<double> direct_point_;
  ShearCoefficient coefficient_;
  ForceFieldView forces_;
  std::array<std::vector<float>, kComponentEnds> ends_;
  std::vector<float> pressure_;
};

}  // namespace pillarfield
