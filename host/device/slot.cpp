#include "device/slot.h"

namespace pillarfield {

ForceFieldView Slot::results() const {
  const std::size_t elements = std::size_t{rows_} * cols_;
  ForceFieldView forces;
  forces.rows = rows_;
  forces.cols = cols_;
  forces.status = {memory().status(), elements};
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto* const values = reinterpret_cast<const float*>(memory().plane(i));
    if (values != nullptr) plane_of(forces, i) = {values, elements};
  }
  return forces;
}

}  // namespace pillarfield
