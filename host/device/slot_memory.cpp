#include "device/slot_memory.h"

#include "device/kernel_source.h"

namespace pillarfield {

ResultLayout::ResultLayout(const SolverPlan& plan, int block_lanes)
    : plane_bytes(plane_distance(plan.skin.pillars() * sizeof(float))) {
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    has[i] = has_planes(plan.angles, plan.uncertainty, kResultPlanes[i].set);
    planes[i] = status;
    if (has[i]) status += plane_bytes;
  }
  bytes = page_aligned(status + plan.skin.pillars());
  if (block_lanes == 0) return;
  lanes = static_cast<std::uint32_t>(block_lanes);
  flag_stride = blocks_of_row(plan.skin.pillar_cols(), lanes);
  idle_flags = plan.skin.pillar_rows() * flag_stride;
}

IdleBlocks SlotMemory::idle_blocks() const {
  if (!shares_flags_) return {};
  const auto* const flags = reinterpret_cast<const std::uint8_t*>(pages_ + layout_.bytes);
  return {{flags, layout_.idle_flags}, layout_.flag_stride, layout_.lanes};
}

}  // namespace pillarfield
