#pragma once

#include <vector>

#include "pillarfield/status.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

/// A field with all planes and readings, 2 x 3 pillars by default, for a test to fill in.
struct MadeUpField {
  std::uint32_t rows, cols;
  std::vector<float> shear_x, shear_y, normal, magnitude, theta, phi;
  std::vector<std::uint8_t> status;
  UncertaintyPlanes<std::vector<float>> uncertainty;

  explicit MadeUpField(std::uint32_t pillar_rows = 2, std::uint32_t pillar_cols = 3)
      : rows(pillar_rows), cols(pillar_cols) {
    const std::size_t pillars = std::size_t{rows} * cols;
    for (auto* plane : {&shear_x, &shear_y, &normal, &magnitude, &theta, &phi}) {
      plane->assign(pillars, 0);
    }
    for (auto& plane : uncertainty) plane.assign(pillars, 0);
    status.assign(pillars, status::kUsable);
  }

  [[nodiscard]] ShownField shown() const {
    ShownField field;
    field.forces = {rows, cols, shear_x, shear_y, normal, status, magnitude, theta, phi, {}};
    for (std::size_t i = 0; i < kUncertaintyPlanes; ++i) {
      const auto plane = static_cast<Uncertainty>(i);
      field.forces.uncertainty[plane] = uncertainty[plane];
    }
    return field;
  }
};

}  // namespace pillarfield::viewer
