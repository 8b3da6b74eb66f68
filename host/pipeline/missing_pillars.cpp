#include "pipeline/missing_pillars.h"

#include <algorithm>

#include "pillarfield/status.h"

namespace pillarfield {

ForceFieldView MissingPillars::without(const ForceFieldView& forces,
                                       std::span<const SenselBlock> missing) {
  ForceFieldView copy = forces;
  status_.assign(forces.status.begin(), forces.status.end());
  copy.status = status_;
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto plane = plane_of(forces, i);
    planes_[i].assign(plane.begin(), plane.end());
    plane_of(copy, i) = planes_[i];
  }
  side_ = forces.shear_x.empty() ? 1 : 2;
  for (const SenselBlock& block : missing) clear(block, forces.rows, forces.cols);
  return copy;
}

void MissingPillars::clear(const SenselBlock& block, std::uint32_t rows, std::uint32_t cols) {
  if (block.rows == 0 || block.cols == 0) return;
  const auto end = [&](std::uint32_t first, std::uint32_t count, std::uint32_t limit) {
    return std::min<std::uint64_t>((std::uint64_t{first} + count + side_ - 1) / side_, limit);
  };
  const std::size_t first = block.first_col / side_;
  const std::size_t last = end(block.first_col, block.cols, cols);
  if (first >= last) return;
  for (std::size_t row = block.first_row / side_; row < end(block.first_row, block.rows, rows);
       ++row) {
    const auto of_row = [&](auto& plane, auto value) {
      if (plane.empty()) return;
      const auto start = plane.begin() + static_cast<std::ptrdiff_t>(row * cols);
      std::fill(start + static_cast<std::ptrdiff_t>(first),
                start + static_cast<std::ptrdiff_t>(last), value);
    };
    for (std::vector<float>& plane : planes_) of_row(plane, 0.0F);
    of_row(status_, status::kInconsistent);
  }
}

}  // namespace pillarfield
