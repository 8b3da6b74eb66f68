#include "device/slot_memory.h"

#include <algorithm>
#include <cstring>

#include "device/kernel_source.h"
#include "pillarfield/calibration.h"
#include "skin/quads.h"

namespace pillarfield {

ResultLayout::ResultLayout(const SolverPlan& plan, int block_lanes)
    : plane_bytes(plane_distance(plan.skin.elements() * sizeof(float))) {
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    has[i] = has_plane(plan.skin.layout, plan.angles, plan.uncertainty, kResultPlanes[i]);
    planes[i] = status;
    if (has[i]) status += plane_bytes;
  }
  bytes = page_aligned(status + plan.skin.elements());
  if (block_lanes == 0) return;
  lanes = static_cast<std::uint32_t>(block_lanes);
  flag_stride = blocks_of_row(quad_cols(plan.skin), lanes);
  idle_flags = quad_rows(plan.skin) * flag_stride;
  flags_hide_missing =
      std::ranges::find(plan.calibration.mask, kMissing) != plan.calibration.mask.end();
}

void ResultMemory::hold_flags() {
  std::memset(pages_ + layout_.bytes, 0, layout_.idle_flags);
  if (layout_.flags_hide_missing) return;
  const auto* const flags = reinterpret_cast<const std::uint8_t*>(pages_ + layout_.bytes);
  idle_ = {{flags, layout_.idle_flags}, layout_.flag_stride, layout_.lanes};
}

void SlotMemory::clear_flags(const cl::CommandQueue& queue) {
  if (layout_.idle_flags == 0) return;
  queue.enqueueFillBuffer(results_, cl_uchar{0}, layout_.bytes, layout_.idle_flags);
  queue.finish();
}

HostMemory::HostMemory(const ResultLayout& layout)
    : ResultMemory(layout), memory_(allocate_large_pages(layout.all_bytes())) {
  pages_ = memory_.get();
  hold_flags();
}

}  // namespace pillarfield
