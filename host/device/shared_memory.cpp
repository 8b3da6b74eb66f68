#include <new>

#include "device/slot_memory.h"

namespace pillarfield {
namespace {

constexpr std::align_val_t kPage{4096};

struct FreePages {
  void operator()(std::byte* pages) const { ::operator delete[](pages, kPage); }
};

struct SharedPlane {
  std::unique_ptr<std::byte[], FreePages> pages;
  cl::Buffer buffer;
  std::size_t bytes = 0;
};

class SharedMemory final : public SlotMemory {
 public:
  SharedMemory(const cl::Context& context, const SolverPlan& plan) : context_(context) {
    for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
      if (!is_wanted(plan, plane)) continue;
      const std::size_t bytes = plan.skin.pillars() * value_size(plan, plane);
      SharedPlane& shared = planes_.at(plane);
      shared.bytes = bytes;
      shared.pages.reset(static_cast<std::byte*>(::operator new[](bytes, kPage)));
      shared.buffer =
          cl::Buffer(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, shared.pages.get());
    }
  }

  DeviceFrame take(const cl::CommandQueue&, const FrameView& frame) override {
    const std::size_t bytes =
        ((frame.rows - 1) * frame.row_stride + frame.cols) * size_of(frame.type);
    // OpenCL takes host memory as non-const even where it is only read.
    void* const memory = const_cast<void*>(frame.data);
    return {cl::Buffer(context_, CL_MEM_READ_ONLY | CL_MEM_USE_HOST_PTR, bytes, memory),
            frame.row_stride};
  }

  void release(const cl::CommandQueue& queue) override {
    if (!mapped_) return;
    for (const SharedPlane& plane : planes_) {
      if (plane.bytes != 0) queue.enqueueUnmapMemObject(plane.buffer, plane.pages.get());
    }
    mapped_ = false;
  }

  void fetch(const cl::CommandQueue& queue) override {
    for (const SharedPlane& plane : planes_) {
      if (plane.bytes != 0) {
        queue.enqueueMapBuffer(plane.buffer, CL_FALSE, CL_MAP_READ, 0, plane.bytes);
      }
    }
    mapped_ = true;
  }

  [[nodiscard]] const cl::Buffer& buffer(std::size_t plane) const override {
    return planes_.at(plane).buffer;
  }
  [[nodiscard]] const std::byte* host(std::size_t plane) const override {
    return planes_.at(plane).pages.get();
  }

 private:
  cl::Context context_;
  std::array<SharedPlane, kAllPlanes> planes_;
  bool mapped_ = false;
};

}  // namespace

std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const SolverPlan& plan) {
  return std::make_unique<SharedMemory>(context, plan);
}

}  // namespace pillarfield
