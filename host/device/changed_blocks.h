#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Flags of the blocks whose results may have changed since a slot was last written
/// (kernels/frame/changed.h): blocks of `lanes` pillars, aligned in the row-by-row index.
class ChangedBlocks {
 public:
  /// All blocks are marked.
  ChangedBlocks(const SolverPlan& plan, int lanes);

  /// Marks the pillars of changed sensels, and those around that depend on them.
  void mark(const SenselBlock& sensels);
  void mark_all();
  void clear();

  /// [rows, flags of a row], then a flag of each row.
  [[nodiscard]] std::span<const std::uint8_t> flags() const { return flags_; }
  /// Bytes of the flags of a plan.
  [[nodiscard]] static std::size_t bytes(const Skin& skin, int lanes);

 private:
  std::uint32_t rows_;  ///< pillars
  std::uint32_t cols_;
  std::uint32_t lanes_;
  std::uint32_t shift_;  ///< lanes_ = 1 << shift_
  std::uint32_t reach_;  ///< pillars beyond its own whose force a sensel may change
  bool solves_all_;      ///< a stage of the plan needs all readings of each frame
  std::vector<std::uint8_t> flags_;
};

}  // namespace pillarfield
