#include <cstring>

#include "device/slot_memory.h"

namespace pillarfield {
namespace {

/// A buffer of the device and memory of the host from which the driver copies without a detour.
// Moving one releases what it held, which throws for an invalid handle only.
struct Stage {  // NOLINT(bugprone-exception-escape)
  Stage() = default;
  Stage(const cl::Context& context, const cl::CommandQueue& queue, cl_mem_flags access,
        std::size_t size)
      : bytes(size),
        on_device(context, access, size),
        pinned(context, CL_MEM_ALLOC_HOST_PTR, size),
        on_host(static_cast<std::byte*>(
            queue.enqueueMapBuffer(pinned, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, size))) {}

  std::size_t bytes = 0;
  cl::Buffer on_device;
  cl::Buffer pinned;
  std::byte* on_host = nullptr;
};

class StagedMemory final : public SlotMemory {
 public:
  StagedMemory(const cl::Context& context, const cl::CommandQueue& queue, const SolverPlan& plan)
      : queue_(queue),
        frame_(context, queue, CL_MEM_READ_ONLY, plan.skin.sensels() * size_of(plan.sensel_type)) {
    for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
      if (!is_wanted(plan, plane)) continue;
      planes_.at(plane) =
          Stage(context, queue, CL_MEM_READ_WRITE, plan.skin.pillars() * value_size(plan, plane));
    }
  }

  ~StagedMemory() override {
    try {
      unmap(frame_);
      for (const Stage& plane : planes_) unmap(plane);
      queue_.finish();
    } catch (const cl::Error&) {
      // The device is gone, and its memory with it.
    }
  }
  StagedMemory(const StagedMemory&) = delete;
  StagedMemory& operator=(const StagedMemory&) = delete;

  DeviceFrame take(const cl::CommandQueue& queue, const FrameView& frame) override {
    const std::size_t row_bytes = frame.cols * size_of(frame.type);
    const std::size_t stride_bytes = frame.row_stride * size_of(frame.type);
    const auto* const readings = static_cast<const std::byte*>(frame.data);
    for (std::size_t row = 0; row < frame.rows; ++row) {
      std::memcpy(frame_.on_host + row * row_bytes, readings + row * stride_bytes, row_bytes);
    }
    queue.enqueueWriteBuffer(frame_.on_device, CL_FALSE, 0, frame_.bytes, frame_.on_host);
    return {frame_.on_device, frame.cols};
  }

  void release(const cl::CommandQueue&) override {}

  void fetch(const cl::CommandQueue& queue) override {
    for (const Stage& plane : planes_) {
      if (plane.bytes == 0) continue;
      queue.enqueueReadBuffer(plane.on_device, CL_FALSE, 0, plane.bytes, plane.on_host);
    }
  }

  [[nodiscard]] const cl::Buffer& buffer(std::size_t plane) const override {
    return planes_.at(plane).on_device;
  }
  [[nodiscard]] const std::byte* host(std::size_t plane) const override {
    return planes_.at(plane).on_host;
  }

 private:
  void unmap(const Stage& stage) const {
    if (stage.bytes != 0) queue_.enqueueUnmapMemObject(stage.pinned, stage.on_host);
  }

  cl::CommandQueue queue_;
  Stage frame_;
  std::array<Stage, kAllPlanes> planes_;
};

}  // namespace

std::unique_ptr<SlotMemory> staged_memory(const cl::Context& context, const cl::CommandQueue& queue,
                                          const SolverPlan& plan) {
  return std::make_unique<StagedMemory>(context, queue, plan);
}

}  // namespace pillarfield
