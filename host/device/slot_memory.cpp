#include "device/slot_memory.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "device/packed_results.h"
#include "device/pinned_memory.h"
#include "skin/quads.h"

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

FrameBuffer PinnedFrames::add(const cl::Context& context, SenselType type, std::uint32_t rows,
                              std::uint32_t cols) {
  std::erase_if(frames_, [](const auto& frame) { return frame.expired(); });
  const cl::CommandQueue queue(context, context.getInfo<CL_CONTEXT_DEVICES>().front());
  const std::size_t bytes = std::size_t{rows} * cols * size_of(type);
  const auto memory = std::make_shared<PinnedMemory>(context, queue, bytes);
  std::shared_ptr<std::byte[]> frame(memory, memory->data());
  frames_.emplace_back(frame);
  return {type, rows, cols, std::move(frame)};
}

bool PinnedFrames::hold(const FrameView& frame) const {
  return frame.row_stride == frame.cols && std::ranges::any_of(frames_, [&](const auto& each) {
           return each.lock().get() == frame.data;
         });
}

namespace {

class StagedMemory final : public SlotMemory {
 public:
  StagedMemory(Device::State& device, const cl::CommandQueue& queue, const SolverPlan& plan,
               const ResultLayout& layout, Transfers& transfers)
      : SlotMemory(layout),
        frames_(transfers.frames),
        frame_bytes_(padded_sensels(plan.skin) * size_of(plan.sensel_type)),
        frame_(device.context, CL_MEM_READ_ONLY, frame_bytes_),
        frame_on_host_(device.context, queue, frame_bytes_),
        // Drivers may map at any alignment: one page more, to begin on a boundary.
        results_on_host_(device.context, queue, layout.bytes + kPageSize) {
    pages_ = results_on_host_.first_page();
    results_ = {device.context, CL_MEM_READ_WRITE, layout.all_bytes()};
    packed_.emplace(device, queue, layout, results_, pages_, transfers.pool);
    idle_ = packed_->idle();
    clear_flags(queue);
  }

  DeviceFrame upload(const cl::CommandQueue& queue, const FrameView& frame) override {
    const void* readings = frame.data;
    if (!frames_.hold(frame)) {
      copy_readings(frame, frame_on_host_.data());
      readings = frame_on_host_.data();
    }
    queue.enqueueWriteBuffer(frame_, CL_FALSE, 0, frame_bytes_, readings);
    return {frame_, frame.cols};
  }

  void download(const cl::CommandQueue& queue) override { packed_->download(queue); }
  bool fetch_rest(const cl::CommandQueue& queue) override { return packed_->fetch_rest(queue); }
  void unpack() override { packed_->unpack(); }

 private:
  const PinnedFrames& frames_;
  std::size_t frame_bytes_;
  cl::Buffer frame_;
  PinnedMemory frame_on_host_;
  PinnedMemory results_on_host_;
  std::optional<PackedResults> packed_;
};

}  // namespace

std::unique_ptr<SlotMemory> staged_memory(Device::State& device, const cl::CommandQueue& queue,
                                          const SolverPlan& plan, const ResultLayout& layout,
                                          Transfers& transfers) {
  return std::make_unique<StagedMemory>(device, queue, plan, layout, transfers);
}

}  // namespace pillarfield
