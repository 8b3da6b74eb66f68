#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "solve/result_planes.h"

namespace pillarfield {

/// A copy of solved frames in which elements without all of their readings have no force and the
/// status of missing sensels.
class MissingPillars {
 public:
  /// Returns `forces` without the elements that touch the blocks of sensels; the view is valid
  /// until the next call.
  [[nodiscard]] ForceFieldView without(const ForceFieldView& forces,
                                       std::span<const SenselBlock> missing);

 private:
  void clear(const SenselBlock& block, std::uint32_t rows, std::uint32_t cols);

  std::array<std::vector<float>, kSolvedPlanes> planes_;
  std::vector<std::uint8_t> status_;
  std::uint32_t side_ = 2;  // sensels of an element, in each direction
};

}  // namespace pillarfield
