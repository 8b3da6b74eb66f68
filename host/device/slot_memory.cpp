#include "device/slot_memory.h"

namespace pillarfield {

ResultLayout::ResultLayout(const SolverPlan& plan) {
  for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
    if (!is_wanted(plan, plane)) continue;
    planes.at(plane) = {bytes, plan.skin.pillars() * value_size(plane)};
    bytes += (planes.at(plane).size + kPageSize - 1) / kPageSize * kPageSize;
  }
}

MarkLayout::MarkLayout(const SolverPlan& plan, int lanes)
    : stride(plan.skin.pillar_cols() / static_cast<std::size_t>(lanes) + 2),
      pillars(static_cast<std::uint32_t>(lanes)) {
  bytes = plan.skin.pillar_rows() * stride;
}

}  // namespace pillarfield
