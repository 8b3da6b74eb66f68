#include <cstring>

#include "device/large_pages.h"
#include "device/slot_memory.h"

namespace pillarfield {
namespace {

/// All planes of a result and the marks in one block, each on its own page: handing it to the
/// device and back is one command each way, and commands are what a small frame's time goes into.
class SharedMemory final : public SlotMemory {
 public:
  SharedMemory(const cl::Context& context, const SolverPlan& plan, const MarkLayout& marks)
      : context_(context),
        layout_(plan),
        mark_layout_(marks),
        bytes_(layout_.bytes + marks.bytes),
        pages_(allocate_large_pages(bytes_)),
        all_(context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes_, pages_.get()) {
    if (marks.bytes > 0) {
      std::memset(pages_.get() + layout_.bytes, 0, marks.bytes);
      const cl_buffer_region region = {layout_.bytes, marks.bytes};
      marks_ = all_.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region);
    }
    for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
      if (layout_.planes.at(plane).size == 0) continue;
      buffers_.at(plane) = all_.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION,
                                                &layout_.planes.at(plane));
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
    if (mapped_) queue.enqueueUnmapMemObject(all_, pages_.get());
    mapped_ = false;
  }

  void fetch(const cl::CommandQueue& queue) override {
    queue.enqueueMapBuffer(all_, CL_FALSE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes_);
    mapped_ = true;
  }

  [[nodiscard]] const cl::Buffer& buffer(std::size_t plane) const override {
    return buffers_.at(plane);
  }
  [[nodiscard]] std::byte* host(std::size_t plane) const override {
    const cl_buffer_region& region = layout_.planes.at(plane);
    return region.size == 0 ? nullptr : pages_.get() + region.origin;
  }
  [[nodiscard]] std::span<const std::byte> pages() const override {
    return {pages_.get(), layout_.bytes};
  }
  [[nodiscard]] const cl::Buffer& marks() const override { return marks_; }
  [[nodiscard]] SilentBlocks silence() const override {
    const auto* const marks = reinterpret_cast<const std::uint8_t*>(pages_.get() + layout_.bytes);
    return {{marks, mark_layout_.bytes}, mark_layout_.stride, mark_layout_.pillars};
  }

 private:
  cl::Context context_;
  ResultLayout layout_;
  MarkLayout mark_layout_;
  std::size_t bytes_;
  LargePages pages_;
  cl::Buffer all_;
  std::array<cl::Buffer, kAllPlanes> buffers_;
  cl::Buffer marks_;
  bool mapped_ = false;
};

}  // namespace

std::unique_ptr<SlotMemory> shared_memory(const cl::Context& context, const SolverPlan& plan,
                                          const MarkLayout& marks) {
  return std::make_unique<SharedMemory>(context, plan, marks);
}

}  // namespace pillarfield
