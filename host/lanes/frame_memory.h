#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/large_pages.h"
#include "lanes/calibration_memory.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"
#include "solve/idle_blocks.h"
#include "solve/pillar_maths.h"
#include "solve/result_planes.h"

namespace pillarfield {

/// Distance of planes of `bytes`: 768 bytes above whole pages. The lines that a block of pillars
/// writes to up to 16 planes then lie in different sets of a cache; on whole pages all share one.
/// The planes stay aligned to 256 bytes.
constexpr std::size_t plane_distance(std::size_t bytes) {
  constexpr std::size_t kSkew = 768;
  return page_aligned(bytes < kSkew ? 0 : bytes - kSkew) + kSkew;
}

/// Offsets of the planes of a result in one block of pages, bytes; the flags of idle blocks follow
/// the planes.
struct ResultLayout {
  /// `block_lanes`: pillars of a block that may be idle; 0: no flags.
  ResultLayout(const SolverPlan& plan, int block_lanes);

  std::uint32_t rows;  ///< of elements
  std::uint32_t cols;
  std::array<std::size_t, kSolvedPlanes> planes{};  ///< offset from the first one
  std::array<bool, kSolvedPlanes> has{};            ///< planes of the plan
  std::size_t plane_bytes = 0;                      ///< distance between planes
  std::size_t status = 0;
  std::size_t bytes = 0;            ///< of the block; the flags follow
  std::size_t idle_flags = 0;       ///< number of flags
  std::size_t scratch = 0;          ///< bytes that only the solve uses, after the flags
  std::size_t flag_stride = 0;      ///< flags of a pillar row
  bool flags_hide_missing = false;  ///< idle blocks may hold masked pillars, which contacts bridge
  std::uint32_t lanes = 1;          ///< pillars of a flag

  /// Offset of the scratch memory.
  [[nodiscard]] std::size_t scratch_begin() const { return page_aligned(bytes + idle_flags); }
  /// Bytes of everything.
  [[nodiscard]] std::size_t all_bytes() const { return scratch_begin() + scratch; }
};

/// Division of a frame among work-items.
struct Division {
  int lanes = 1;          ///< pillars that one solves at once
  std::size_t bands = 1;  ///< bands of rows
  bool has_rings = true;  ///< each band keeps the rows around its own: kernels/frame/neighbours.h
};

/// The memory of a slot: results, idle flags, and scratch memory.
struct SlotLayout {
  SlotLayout(const SolverPlan& plan, const Division& division, bool skips_idle,
             const CalibrationMemory& calibration);

  ResultLayout results;
  single_precision::Layout layout{};
  std::size_t tiles_across = 0;  ///< of wires; 0 without their crosstalk
  std::size_t tiles_down = 0;
};

/// The results of a frame in host memory.
class ResultMemory {
 public:
  virtual ~ResultMemory() = default;
  ResultMemory(const ResultMemory&) = delete;
  ResultMemory& operator=(const ResultMemory&) = delete;

  [[nodiscard]] const ResultLayout& layout() const { return layout_; }
  /// A plane; null if the plan does not have it. Shared memory passes writes on to the device.
  [[nodiscard]] std::byte* plane(std::size_t index) const {
    return layout_.has[index] ? pages_ + layout_.planes[index] : nullptr;
  }
  [[nodiscard]] std::uint8_t* status() const {
    return reinterpret_cast<std::uint8_t*>(pages_ + layout_.status);
  }
  /// The results; the planes of the plan.
  [[nodiscard]] ForceFieldView forces() const;
  /// The block of whole pages that holds all planes; it does not move.
  [[nodiscard]] std::span<const std::byte> pages() const { return {pages_, layout_.bytes}; }
  /// The flags of idle blocks; none if they stay on the device, or hide missing pillars.
  [[nodiscard]] const IdleBlocks& idle_blocks() const { return idle_; }

 protected:
  explicit ResultMemory(const ResultLayout& layout) : layout_(layout) {}

  /// Clears the flags of idle blocks, which follow the pages: none is idle.
  void hold_flags();

  ResultLayout layout_;
  std::byte* pages_ = nullptr;
  IdleBlocks idle_;
};

/// Results that the host itself writes.
class HostMemory final : public ResultMemory {
 public:
  explicit HostMemory(const ResultLayout& layout);

  /// Results, idle flags and scratch memory.
  [[nodiscard]] std::byte* bytes() const { return pages_; }
  void clear_flags() { hold_flags(); }

 private:
  LargePages memory_;
};

}  // namespace pillarfield
