#include <memory>

#include "device/slot_memory.h"
#include "skin/quads.h"

namespace pillarfield {
namespace {

/// Pinned host memory: the driver copies from and to it directly.
class PinnedMemory {
 public:
  PinnedMemory(const cl::Context& context, const cl::CommandQueue& queue, std::size_t bytes)
      : queue_(queue),
        buffer_(context, CL_MEM_ALLOC_HOST_PTR, bytes),
        mapped_(queue.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes)),
        bytes_(bytes) {}
  ~PinnedMemory() {
    try {
      queue_.enqueueUnmapMemObject(buffer_, mapped_);
      queue_.finish();
    } catch (const cl::Error&) {
      // The device and its memory are gone.
    }
  }
  PinnedMemory(const PinnedMemory&) = delete;
  PinnedMemory& operator=(const PinnedMemory&) = delete;

  [[nodiscard]] std::byte* data() const { return static_cast<std::byte*>(mapped_); }

  /// Its first page boundary.
  [[nodiscard]] std::byte* first_page() const {
    void* place = mapped_;
    std::size_t space = bytes_;
    return static_cast<std::byte*>(std::align(kPageSize, 1, place, space));
  }

 private:
  cl::CommandQueue queue_;
  cl::Buffer buffer_;
  void* mapped_;
  std::size_t bytes_;
};

class StagedMemory final : public SlotMemory {
 public:
  StagedMemory(const cl::Context& context, const cl::CommandQueue& queue, const SolverPlan& plan,
               const ResultLayout& layout)
      : SlotMemory(layout),
        frame_bytes_(padded_sensels(plan.skin) * size_of(plan.sensel_type)),
        frame_(context, CL_MEM_READ_ONLY, frame_bytes_),
        frame_on_host_(context, queue, frame_bytes_),
        // Drivers may map at any alignment: one page more, to begin on a boundary.
        results_on_host_(context, queue, layout.bytes + kPageSize) {
    pages_ = results_on_host_.first_page();
    results_ = {context, CL_MEM_READ_WRITE, layout.all_bytes()};
    clear_flags(queue);
  }

  DeviceFrame upload(const cl::CommandQueue& queue, const FrameView& frame) override {
    copy_readings(frame, frame_on_host_.data());
    queue.enqueueWriteBuffer(frame_, CL_FALSE, 0, frame_bytes_, frame_on_host_.data());
    return {frame_, frame.cols};
  }

  void download(const cl::CommandQueue& queue) override {
    queue.enqueueReadBuffer(results_, CL_FALSE, 0, layout_.bytes, pages_);
  }

 private:
  std::size_t frame_bytes_;
  cl::Buffer frame_;
  PinnedMemory frame_on_host_;
  PinnedMemory results_on_host_;
};

}  // namespace

std::unique_ptr<SlotMemory> staged_memory(const cl::Context& context, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const ResultLayout& layout) {
  return std::make_unique<StagedMemory>(context, queue, plan, layout);
}

}  // namespace pillarfield
