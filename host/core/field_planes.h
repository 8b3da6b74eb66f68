#pragma once

#include <vector>

#include "core/pillar_maths.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// A plane's values; null where it is empty.
inline float* values_or_null(std::vector<float>& plane) {
  return plane.empty() ? nullptr : plane.data();
}

/// The planes of a field, as the estimators of contacts take them.
[[nodiscard]] inline single_precision::Field planes_of(ForceField& field) {
  auto& uncertainty = field.uncertainty;
  return {field.shear_x.data(),
          field.shear_y.data(),
          field.normal.data(),
          field.status.data(),
          nullptr,
          nullptr,
          nullptr,
          values_or_null(uncertainty[Uncertainty::shear_x]),
          values_or_null(uncertainty[Uncertainty::shear_y]),
          values_or_null(uncertainty[Uncertainty::normal]),
          values_or_null(uncertainty[Uncertainty::theta_low]),
          values_or_null(uncertainty[Uncertainty::theta_high]),
          values_or_null(uncertainty[Uncertainty::phi_low]),
          values_or_null(uncertainty[Uncertainty::phi_high]),
          values_or_null(uncertainty[Uncertainty::magnitude_low]),
          values_or_null(uncertainty[Uncertainty::magnitude_high]),
          field.rows,
          field.cols};
}

}  // namespace pillarfield
