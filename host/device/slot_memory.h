#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "device/large_pages.h"
#include "device/opencl.h"
#include "pillarfield/frame.h"
#include "pillarfield/processor.h"
#include "solve/idle_blocks.h"
#include "solve/pillar_maths.h"
#include "solve/result_planes.h"

namespace pillarfield {

inline constexpr std::size_t kPageSize = 4096;

constexpr std::size_t page_aligned(std::size_t bytes) {
  return (bytes + kPageSize - 1) / kPageSize * kPageSize;
}

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

  std::array<std::size_t, kSolvedPlanes> planes{};  ///< offset from the first one
  std::array<bool, kSolvedPlanes> has{};            ///< planes of the plan
  std::size_t plane_bytes = 0;                      ///< distance between planes
  std::size_t status = 0;
  std::size_t bytes = 0;            ///< of the block; the flags follow
  std::size_t idle_flags = 0;       ///< number of flags
  std::size_t scratch = 0;          ///< bytes that only the device uses, after the flags
  std::size_t flag_stride = 0;      ///< flags of a pillar row
  bool flags_hide_missing = false;  ///< idle blocks may hold masked pillars, which contacts bridge
  std::uint32_t lanes = 1;          ///< pillars of a flag

  /// Offset of the scratch memory.
  [[nodiscard]] std::size_t scratch_begin() const { return page_aligned(bytes + idle_flags); }
  /// Bytes of everything.
  [[nodiscard]] std::size_t all_bytes() const { return scratch_begin() + scratch; }
};

/// A frame that the kernel can read.
struct DeviceFrame {
  cl::Buffer readings;
  std::uint64_t row_stride = 0;  ///< readings
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

/// Transfers one frame to the device and its result back. The device owns the memory between
/// upload() and download(), the host otherwise.
class SlotMemory : public ResultMemory {
 public:
  /// Makes the frame's readings and memory for its results available to the next commands on
  /// `queue`.
  virtual DeviceFrame upload(const cl::CommandQueue& queue, const FrameView& frame) = 0;

  /// Starts the transfer of the results to the host.
  virtual void download(const cl::CommandQueue& queue) = 0;

  /// Clears the flags of idle blocks while no command runs; what the host reads stays.
  virtual void clear_flags(const cl::CommandQueue& queue);

  /// Returns the memory to the device, before both end: PoCL leaks a buffer that is still mapped.
  virtual void release(const cl::CommandQueue& queue) { static_cast<void>(queue); }

  /// Results and idle flags, which the kernel writes; the flags are zero at first.
  [[nodiscard]] const cl::Buffer& results() const { return results_; }

 protected:
  using ResultMemory::ResultMemory;

  cl::Buffer results_;
};

/// Zero copy: the kernel reads the caller's memory and writes memory that the caller reads.
std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const ResultLayout& layout);

/// Copies through pinned memory of the driver: one copy by the host and one by the device in each
/// direction.
std::unique_ptr<SlotMemory> staged_memory(const cl::Context& context, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const ResultLayout& layout);

}  // namespace pillarfield
