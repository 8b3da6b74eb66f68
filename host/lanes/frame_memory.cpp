#include "lanes/frame_memory.h"

#include <algorithm>
#include <cstring>

#include "pillarfield/calibration.h"
#include "skin/quads.h"

namespace pillarfield {
namespace {

/// Blocks of a pillar row at most, the stride of flags; as in kernels/frame/calibration_planes.h.
constexpr std::size_t blocks_of_row(std::uint32_t pillar_cols, std::uint32_t lanes) {
  return pillar_cols / lanes + 2;
}

std::size_t tiles_of(std::size_t quads, std::size_t tile) { return (2 * quads + tile - 1) / tile; }

/// Floats of the rings of kernels/frame/neighbours.h.
std::size_t ring_floats(const SolverPlan& plan, const Division& division) {
  if (!plan.calibration.effects.sensel_leak || !division.has_rings) return 0;
  constexpr std::size_t kRows = 3;  // PF_RING_ROWS
  const std::uint32_t cols = quad_cols(plan.skin);
  const std::size_t flags = kRows * blocks_of_row(cols, static_cast<std::uint32_t>(division.lanes));
  return division.bands *
         (4 * kRows * (std::size_t{cols} + 2) + (flags + sizeof(float) - 1) / sizeof(float));
}

/// Floats of the rows of kernels/frame/correct_forces.cl, with the pillars before the first and
/// after the last, which it reads in vain.
std::size_t ratio_floats(const SolverPlan& plan, const Division& division) {
  if (!plan.calibration.effects.arm_mm) return 0;
  constexpr std::size_t kRows = 5;    // kRatioRows
  constexpr std::size_t kValues = 8;  // of both axes
  const std::size_t rows = division.lanes > 1 ? kRows * division.bands : quad_rows(plan.skin);
  return rows * kValues * quad_cols(plan.skin) + 1 + static_cast<std::size_t>(division.lanes);
}

}  // namespace

ResultLayout::ResultLayout(const SolverPlan& plan, int block_lanes)
    : rows(plan.skin.element_rows()),
      cols(plan.skin.element_cols()),
      plane_bytes(plane_distance(plan.skin.elements() * sizeof(float))) {
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

SlotLayout::SlotLayout(const SolverPlan& plan, const Division& division, bool skips_idle,
                       const CalibrationMemory& calibration)
    : results(plan, skips_idle ? division.lanes : 0) {
  const SensorEffects& effects = plan.calibration.effects;
  std::size_t wires = 0;  // floats of the vectors of kernels/frame/wire_vectors.h
  if (effects.wires) {
    tiles_across = tiles_of(quad_cols(plan.skin), effects.wires->tile_cols);
    tiles_down = tiles_of(quad_rows(plan.skin), effects.wires->tile_rows);
    wires = 2 * (3 * tiles_across * quad_rows(plan.skin) + tiles_down * quad_cols(plan.skin));
  }
  layout = {.row_stride = 0,
            .rows = quad_rows(plan.skin),
            .cols = quad_cols(plan.skin),
            .sensel_rows = plan.skin.rows,
            .sensel_cols = plan.skin.cols,
            .plane_stride = calibration.stride(),
            .plane_bytes = calibration.plane_bytes(),
            .result_bytes = results.plane_bytes,
            .status = results.status,
            .touched = results.status,
            .idle = results.bytes,
            .ring = 0,
            .wires = 0,
            .frame = 0,
            .forces = 0,
            .ratios = 0};
  const auto scratch = [&](std::size_t bytes) {
    const std::size_t begin = results.all_bytes();
    results.scratch += bytes;
    return begin;
  };
  layout.forces = scratch(effects.pillar_leak ? 3 * results.plane_bytes : 0);
  layout.ratios = scratch(ratio_floats(plan, division) * sizeof(float));
  layout.ring = scratch(ring_floats(plan, division) * sizeof(float));
  layout.wires = scratch(wires * sizeof(float));
  const bool marks_touched = plan.baseline_rate && !plan.skin.has_pillars();
  if (marks_touched) layout.touched = scratch(quads(plan.skin));
}

ForceFieldView ResultMemory::forces() const {
  const std::size_t elements = std::size_t{layout_.rows} * layout_.cols;
  ForceFieldView forces;
  forces.rows = layout_.rows;
  forces.cols = layout_.cols;
  forces.status = {status(), elements};
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto* const values = reinterpret_cast<const float*>(plane(i));
    if (values != nullptr) plane_of(forces, i) = {values, elements};
  }
  return forces;
}

void ResultMemory::hold_flags() {
  std::memset(pages_ + layout_.bytes, 0, layout_.idle_flags);
  if (layout_.flags_hide_missing) return;
  const auto* const flags = reinterpret_cast<const std::uint8_t*>(pages_ + layout_.bytes);
  idle_ = {{flags, layout_.idle_flags}, layout_.flag_stride, layout_.lanes};
}

HostMemory::HostMemory(const ResultLayout& layout)
    : ResultMemory(layout), memory_(allocate_large_pages(layout.all_bytes())) {
  pages_ = memory_.get();
  hold_flags();
}

}  // namespace pillarfield
