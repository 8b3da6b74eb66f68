#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include "device/opencl.h"
#include "pillarfield/frame.h"
#include "pillarfield/processor.h"
#include "solve/silent_blocks.h"

namespace pillarfield {

/// The planes of a result, in the order of the kernel's arguments; the planes of Uncertainty follow
/// from kUncertainty on.
enum ResultPlane : std::size_t {
  kShearX,
  kShearY,
  kNormal,
  kStatus,
  kMagnitude,
  kTheta,
  kPhi,
  kUncertainty
};
inline constexpr std::size_t kAllPlanes = kUncertainty + kUncertaintyPlanes;

/// Whether a plan asks for a plane.
constexpr bool is_wanted(const SolverPlan& plan, std::size_t plane) {
  if (plane >= kUncertainty) return plan.uncertainty;
  return plane < kMagnitude || plan.angles;
}

/// Bytes of one value of a plane.
constexpr std::size_t value_size(std::size_t plane) { return plane == kStatus ? 1 : sizeof(float); }

inline constexpr std::size_t kPageSize = 4096;

/// Where the planes of a result lie in one block of whole pages, each plane on a page of its own.
/// A plane that the plan does not ask for has no size.
struct ResultLayout {
  explicit ResultLayout(const SolverPlan& plan);

  std::array<cl_buffer_region, kAllPlanes> planes{};
  std::size_t bytes = 0;  ///< of the block
};

/// A frame that the kernel can read.
struct DeviceFrame {
  cl::Buffer readings;
  cl_ulong row_stride = 0;  ///< readings
};

/// How one frame reaches the device and its result comes back. A slot calls take(), release(), the
/// kernel, fetch(), and after the queue is finished results().
class SlotMemory {
 public:
  virtual ~SlotMemory() = default;

  /// Makes the frame's readings available to commands that follow on `queue`.
  virtual DeviceFrame take(const cl::CommandQueue& queue, const FrameView& frame) = 0;

  /// Hands the results' memory to the device.
  virtual void release(const cl::CommandQueue& queue) = 0;

  /// Starts bringing the results to the host.
  virtual void fetch(const cl::CommandQueue& queue) = 0;

  /// The buffer that the kernel writes a plane to; null for a plane without.
  [[nodiscard]] virtual const cl::Buffer& buffer(std::size_t plane) const = 0;

  /// The host's side of a plane, valid from the end of fetch() to the next release(). What is
  /// written there stays; where memory is shared, the device sees it.
  [[nodiscard]] virtual std::byte* host(std::size_t plane) const = 0;

  /// The block that the host's sides of all planes lie in: whole pages, always the same.
  [[nodiscard]] virtual std::span<const std::byte> pages() const = 0;

  /// Where the kernel marks the blocks whose results are those of silence, none at first; null
  /// where none is to be skipped.
  [[nodiscard]] virtual const cl::Buffer& marks() const = 0;

  /// The same for the host, valid as host(); empty where it cannot read them.
  [[nodiscard]] virtual SilentBlocks silence() const { return {}; }
};

/// How many marks there are, and what of. None: no block is skipped.
struct MarkLayout {
  MarkLayout() = default;
  MarkLayout(const SolverPlan& plan, int lanes);

  std::size_t bytes = 0;
  std::size_t stride = 0;     ///< marks of a pillar row
  std::uint32_t pillars = 1;  ///< of a block
};

/// Zero copy: the kernel reads the caller's memory and writes the memory the caller reads.
std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const SolverPlan& plan,
                                          const MarkLayout& marks);

/// Through pinned memory of the driver: one copy by the host, one by the device, each way one.
std::unique_ptr<SlotMemory> staged_memory(const cl::Context& context, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const MarkLayout& marks);

}  // namespace pillarfield
