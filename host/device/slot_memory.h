#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

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

/// Where the planes of a result lie in one block of whole pages, each on a page of its own, and
/// behind it the marks of idle blocks. In bytes.
struct ResultLayout {
  /// `lanes` are the pillars of a block that may be idle; 0: there are no marks.
  ResultLayout(const SolverPlan& plan, int lanes);

  std::array<std::size_t, kSolvedPlanes> planes{};  ///< from the first one on
  std::array<bool, kSolvedPlanes> has{};            ///< what the plan asks for
  std::size_t plane_bytes = 0;                      ///< from one to the next
  std::size_t status = 0;
  std::size_t bytes = 0;        ///< of the block; the marks follow
  std::size_t marks = 0;        ///< how many
  std::size_t mark_stride = 0;  ///< marks of a pillar row
  std::uint32_t lanes = 1;      ///< pillars of a mark
};

/// A frame that the kernel can read.
struct DeviceFrame {
  cl::Buffer readings;
  std::uint64_t row_stride = 0;  ///< readings
};

/// How one frame reaches the device and its result comes back. Between upload() and download() the
/// memory is the device's, elsewhere the host's.
class SlotMemory {
 public:
  virtual ~SlotMemory() = default;

  /// Makes the frame's readings, and memory for its results, available to commands that follow on
  /// `queue`.
  virtual DeviceFrame upload(const cl::CommandQueue& queue, const FrameView& frame) = 0;

  /// Starts bringing the results to the host.
  virtual void download(const cl::CommandQueue& queue) = 0;

  [[nodiscard]] const ResultLayout& layout() const { return layout_; }
  /// What the kernel writes: results and marks, which are zero at first.
  [[nodiscard]] const cl::Buffer& results() const { return results_; }
  /// The host's side of a plane; null for one that the plan does not ask for. What is written there
  /// stays; where memory is shared, the device sees it.
  [[nodiscard]] std::byte* plane(std::size_t index) const {
    return layout_.has[index] ? pages_ + layout_.planes[index] : nullptr;
  }
  [[nodiscard]] std::uint8_t* status() const {
    return reinterpret_cast<std::uint8_t*>(pages_ + layout_.status);
  }
  /// The block that the host's sides of all planes lie in: whole pages, always the same.
  [[nodiscard]] std::span<const std::byte> pages() const { return {pages_, layout_.bytes}; }
  /// The marks; none where they stay on the device.
  [[nodiscard]] IdleBlocks idle_blocks() const;

 protected:
  explicit SlotMemory(ResultLayout layout) : layout_(layout) {}

  ResultLayout layout_;
  cl::Buffer results_;
  std::byte* pages_ = nullptr;
  bool shares_marks_ = false;  ///< they lie behind the host's pages too
};

/// Zero copy: the kernel reads the caller's memory and writes the memory the caller reads.
std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const ResultLayout& layout);

/// Through pinned memory of the driver: one copy by the host, one by the device, each way one.
std::unique_ptr<SlotMemory> staged_memory(const cl::Context& context, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const ResultLayout& layout);

}  // namespace pillarfield
