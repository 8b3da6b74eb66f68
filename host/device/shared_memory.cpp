#include "device/slot_memory.h"

namespace pillarfield {
namespace {

class SharedMemory final : public SlotMemory {
 public:
  SharedMemory(const cl::Context& context, const ResultLayout& layout)
      : SlotMemory(layout),
        context_(context),
        bytes_(layout.all_bytes()),
        memory_(allocate_large_pages(bytes_)) {
    pages_ = memory_.get();
    hold_flags();
    results_ = {context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes_, pages_};
  }

  DeviceFrame upload(const cl::CommandQueue& queue, const FrameView& frame) override {
    release(queue);
    const std::size_t bytes =
        ((frame.rows - 1) * frame.row_stride + frame.cols) * size_of(frame.type);
    // OpenCL requires a non-const pointer even to read-only host memory.
    void* const memory = const_cast<void*>(frame.data);
    return {cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes, memory),
            frame.row_stride};
  }

  void download(const cl::CommandQueue& queue) override {
    queue.enqueueMapBuffer(results_, CL_FALSE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes_);
    mapped_ = true;
  }

  void clear_flags(const cl::CommandQueue& queue) override {
    const bool was_mapped = mapped_;
    release(queue);
    SlotMemory::clear_flags(queue);
    if (was_mapped) download(queue);
    queue.finish();
  }

  void release(const cl::CommandQueue& queue) override {
    if (mapped_) queue.enqueueUnmapMemObject(results_, pages_);
    mapped_ = false;
  }

 private:
  cl::Context context_;
  std::size_t bytes_;
  LargePages memory_;
  bool mapped_ = false;
};

}  // namespace

std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const ResultLayout& layout) {
  return std::make_unique<SharedMemory>(context, layout);
}

}  // namespace pillarfield
