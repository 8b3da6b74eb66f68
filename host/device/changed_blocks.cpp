#include "device/changed_blocks.h"

#include <algorithm>
#include <bit>

#include "device/block_lanes.h"
#include "solve/stages.h"

namespace pillarfield {

std::size_t ChangedBlocks::bytes(const Skin& skin, int lanes) {
  return skin.pillar_rows() *
         (blocks_of_row(skin.pillar_cols(), static_cast<std::uint32_t>(lanes)) + 1);
}

ChangedBlocks::ChangedBlocks(const SolverPlan& plan, int lanes)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      lanes_(static_cast<std::uint32_t>(lanes)),
      shift_(static_cast<std::uint32_t>(std::countr_zero(lanes_))),
      reach_(neighbour_reach(plan)),
      solves_all_(!may_solve_changes(plan)),
      flags_(bytes(plan.skin, lanes), 1) {}

void ChangedBlocks::mark(const SenselBlock& sensels) {
  if (solves_all_) return mark_all();
  if (sensels.rows == 0 || sensels.cols == 0) return;
  const auto before = [this](std::uint32_t sensel) {
    return std::max(sensel / 2, reach_) - reach_;
  };
  const auto after = [this](std::uint32_t sensel, std::uint32_t pillars) {
    return std::min(sensel / 2 + reach_ + 1, pillars);
  };
  const std::uint32_t first_col = before(sensels.first_col);
  const std::uint32_t end_col = after(sensels.first_col + sensels.cols - 1, cols_);
  if (first_col >= end_col) return;  // The last odd column has no pillar.
  const std::size_t stride = blocks_of_row(cols_, lanes_);
  const std::uint32_t end_row = after(sensels.first_row + sensels.rows - 1, rows_);
  for (std::uint32_t row = before(sensels.first_row); row < end_row; ++row) {
    const std::size_t skew = std::size_t{row} * cols_ & (lanes_ - 1);  // A power of two.
    const std::size_t first = (skew + first_col) >> shift_;
    const std::size_t last = (skew + end_col - 1) >> shift_;
    std::fill_n(&flags_[row * stride + first], last - first + 1, std::uint8_t{1});
    flags_[rows_ * stride + row] = 1;
  }
}

void ChangedBlocks::mark_all() { std::ranges::fill(flags_, std::uint8_t{1}); }
void ChangedBlocks::clear() {
  std::ranges::fill(flags_, solves_all_ ? std::uint8_t{1} : std::uint8_t{0});
}

}  // namespace pillarfield
