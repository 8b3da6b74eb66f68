#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pillarfield/force_field.h"

namespace pillarfield {

/// Pointers to the planes of a result that an estimator updates in place, [rows, cols] each.
struct FieldPlanes {
  float* shear_x = nullptr;
  float* shear_y = nullptr;
  float* normal = nullptr;
  std::uint8_t* status = nullptr;
  float* magnitude = nullptr;  ///< null, like theta and phi, without angles
  float* theta = nullptr;
  float* phi = nullptr;
  UncertaintyPlanes<float*> uncertainty{};  ///< null without uncertainty
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;

  [[nodiscard]] bool has_uncertainty() const { return uncertainty[Uncertainty::normal] != nullptr; }
  [[nodiscard]] float& at(Uncertainty plane, std::size_t index) const {
    return uncertainty[plane][index];
  }
  /// Forces and status.
  [[nodiscard]] ForceFieldView forces() const {
    const std::size_t pillars = std::size_t{rows} * cols;
    ForceFieldView view;
    view.rows = rows;
    view.cols = cols;
    view.shear_x = {shear_x, pillars};
    view.shear_y = {shear_y, pillars};
    view.normal = {normal, pillars};
    view.status = {status, pillars};
    return view;
  }
};

[[nodiscard]] inline FieldPlanes planes_of(ForceField& field) {
  const auto values_or_null = [](std::vector<float>& plane) {
    return plane.empty() ? nullptr : plane.data();
  };
  FieldPlanes planes;
  planes.rows = field.rows;
  planes.cols = field.cols;
  planes.shear_x = field.shear_x.data();
  planes.shear_y = field.shear_y.data();
  planes.normal = field.normal.data();
  planes.status = field.status.data();
  std::ranges::transform(field.uncertainty, planes.uncertainty.begin(), values_or_null);
  return planes;
}

}  // namespace pillarfield
