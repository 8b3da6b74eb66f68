#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "base/thread_pool.h"
#include "device/device_state.h"
#include "device/opencl.h"
#include "lanes/frame_memory.h"
#include "pillarfield/frame.h"

namespace pillarfield {

/// A frame that the kernel can read.
struct DeviceFrame {
  cl::Buffer readings;
  std::uint64_t row_stride = 0;  ///< readings
};

/// Frames in pinned memory, which the driver copies from directly.
class PinnedFrames {
 public:
  /// A new frame.
  [[nodiscard]] FrameBuffer add(const cl::Context& context, SenselType type, std::uint32_t rows,
                                std::uint32_t cols);
  /// True if the frame is the whole of one that add() made.
  [[nodiscard]] bool hold(const FrameView& frame) const;

 private:
  std::vector<std::weak_ptr<std::byte[]>> frames_;
};

/// Shared by all slots of a device with its own memory.
struct Transfers {
  explicit Transfers(std::size_t threads) : pool(threads) {}

  PinnedFrames frames;
  ThreadPool pool;  ///< unpacks results
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

  /// After the commands of download(): starts to fetch results that it left out; false if there are
  /// none.
  [[nodiscard]] virtual bool fetch_rest(const cl::CommandQueue& queue) {
    static_cast<void>(queue);
    return false;
  }

  /// After all commands: puts the results into their planes.
  virtual void unpack() {}

  /// Clears the flags of idle blocks while no command runs; what the host reads stays.
  virtual void clear_flags(const cl::CommandQueue& queue) {
    if (layout_.idle_flags == 0) return;
    queue.enqueueFillBuffer(results_, cl_uchar{0}, layout_.bytes, layout_.idle_flags);
    queue.finish();
  }

  /// Returns the memory to the device, before both end: PoCL never frees a buffer that is still
  /// mapped.
  virtual void release(const cl::CommandQueue& queue) { static_cast<void>(queue); }

  /// Results and idle flags, which the kernel writes; the flags are zero at first.
  [[nodiscard]] const cl::Buffer& results() const { return results_; }

 protected:
  using ResultMemory::ResultMemory;

  cl::Buffer results_;
};

/// Zero copy: the kernel reads the caller's memory and writes memory that the caller reads.
std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const ResultLayout& layout);

/// Copies through pinned memory of the driver: frames, but those in `transfers.frames`, once by the
/// host and once by the device; results as PackedResults does.
std::unique_ptr<SlotMemory> staged_memory(Device::State& device, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const ResultLayout& layout,
                                          Transfers& transfers);

}  // namespace pillarfield
