#include "bench/timing/copy_kernel.h"

#include <sys/mman.h>

#include <algorithm>
#include <new>
#include <utility>

namespace pillarfield::bench {
namespace {

constexpr cl_uint kRawArgument = 0;
constexpr std::size_t kGroup = 64;  ///< as the solver's, where a work-item has one pillar
constexpr std::size_t kLargePage = std::size_t{1} << 21U;  ///< bytes

/// The device that DeviceInfo::index counts among those of all platforms.
cl::Device device_at(int index) {
  std::vector<cl::Platform> platforms;
  cl::Platform::get(&platforms);
  std::vector<cl::Device> all;
  for (const cl::Platform& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue;  // A driver without devices.
    }
    all.insert(all.end(), devices.begin(), devices.end());
  }
  return all.at(static_cast<std::size_t>(index));
}

/// Uninitialised memory in large pages, which the system may refuse.
std::byte* allocate_pages(std::size_t bytes) {
  const std::size_t size = (bytes + kLargePage - 1) / kLargePage * kLargePage;
  auto* const memory = static_cast<std::byte*>(std::aligned_alloc(kLargePage, size));
  if (memory == nullptr) throw std::bad_alloc();
  static_cast<void>(madvise(memory, size, MADV_HUGEPAGE));
  return memory;
}

/// The frames as the device reads them, made before anything is timed.
std::vector<cl::Buffer> frame_buffers(const cl::Context& context, bool shared,
                                      const Frames& frames) {
  std::vector<cl::Buffer> buffers;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameView frame = frames[i];
    const std::size_t bytes = std::size_t{frame.rows} * frame.cols * size_of(frame.type);
    buffers.emplace_back(context,
                         CL_MEM_READ_ONLY | (shared ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR),
                         bytes, const_cast<void*>(frame.data));
  }
  return buffers;
}

}  // namespace

OpenedDevice::OpenedDevice(const Device& opened)
    : device(device_at(opened.info().index)), context(device) {}

cl::Program OpenedDevice::program(const std::string& source) const {
  cl::Program built(context, source);
  built.build(device, "-cl-std=CL1.2 -w");
  return built;
}

CopyKernel::CopyKernel(const Device& device, const SolverPlan& plan, const Frames& frames,
                       const CopyKind& kind, int frames_in_flight)
    : device_(device),
      skin_(plan.skin),
      streams_(streams_of(plan)),
      frames_(frame_buffers(device_.context, device.info().shares_memory, frames)),
      shared_(device.info().shares_memory),
      calibration_(numbered<float>(static_cast<std::size_t>(streams_.calibration_planes) *
                                   plane_pitch(skin_.sensels()))),
      mask_(numbered<std::uint8_t>(streams_.mask ? skin_.sensels() : 0)) {
  const int lanes = device.info().lanes;
  if (lanes > 1) {
    global_ = cl::NDRange(1, skin_.pillar_rows());
    local_ = cl::NullRange;
  } else {
    global_ =
        cl::NDRange((skin_.pillar_cols() + kGroup - 1) / kGroup * kGroup, skin_.pillar_rows());
    local_ = cl::NDRange(kGroup, 1);
  }
  const cl::Program program = device_.program(copy_source(streams_, lanes, kind));
  for (int i = 0; i < frames_in_flight; ++i) slots_.push_back(make_slot(program));
}

CopyKernel::Planes CopyKernel::make_planes(std::size_t bytes) const {
  if (!shared_) return {nullptr, cl::Buffer(device_.context, CL_MEM_READ_WRITE, bytes)};
  std::unique_ptr<std::byte[], FreePages> pages(allocate_pages(bytes));
  cl::Buffer buffer(device_.context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, pages.get());
  return {std::move(pages), std::move(buffer)};
}

/// A buffer of `count` nonzero values.
template <class Value>
CopyKernel::Planes CopyKernel::numbered(std::size_t count) const {
  std::vector<Value> values(std::max<std::size_t>(count, 1));
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<Value>(i % 251 + 1);
  Planes planes = make_planes(values.size() * sizeof(Value));
  const cl::CommandQueue queue(device_.context, device_.device);
  queue.enqueueWriteBuffer(planes.buffer, CL_TRUE, 0, values.size() * sizeof(Value), values.data());
  return planes;
}

CopyKernel::Slot CopyKernel::make_slot(const cl::Program& program) const {
  const std::uint64_t pitch = plane_pitch(skin_.pillars());
  const auto planes = static_cast<std::size_t>(streams_.result_planes);
  Slot slot{cl::CommandQueue(device_.context, device_.device), cl::Kernel(program, "copy_streams"),
            make_planes(planes * pitch * sizeof(float)), make_planes(pitch)};
  cl_uint argument = kRawArgument + 1;
  slot.kernel.setArg(argument++, cl_ulong{skin_.cols});
  slot.kernel.setArg(argument++, cl_uint{skin_.pillar_cols()});
  slot.kernel.setArg(argument++, calibration_.buffer);
  slot.kernel.setArg(argument++, cl_ulong{plane_pitch(skin_.sensels())});
  slot.kernel.setArg(argument++, mask_.buffer);
  slot.kernel.setArg(argument++, cl_ulong{skin_.cols});
  slot.kernel.setArg(argument++, slot.results.buffer);
  slot.kernel.setArg(argument++, cl_ulong{pitch});
  slot.kernel.setArg(argument++, slot.status.buffer);
  slot.kernel.setArg(argument++, calibration_.buffer);  // A tare that follows is the first plane.
  return slot;
}

void CopyKernel::start(Slot& slot) {
  slot.kernel.setArg(kRawArgument, frames_[started_ % frames_.size()]);
  slot.queue.enqueueNDRangeKernel(slot.kernel, cl::NullRange, global_, local_);
  slot.queue.flush();
  ++started_;
}

void CopyKernel::run(int frames) {
  for (int i = 0; i < frames; ++i) {
    Slot& slot = slots_[started_ % slots_.size()];
    slot.queue.finish();
    start(slot);
  }
  for (Slot& slot : slots_) slot.queue.finish();
}

std::vector<std::byte> CopyKernel::results() const {
  const Slot& slot = slots_[(started_ + slots_.size() - 1) % slots_.size()];
  const auto planes = static_cast<std::size_t>(streams_.result_planes);
  const std::size_t plane_bytes = skin_.pillars() * sizeof(float);
  std::vector<std::byte> bytes(planes * plane_bytes + skin_.pillars());
  for (std::size_t plane = 0; plane < planes; ++plane) {
    slot.queue.enqueueReadBuffer(slot.results.buffer, CL_TRUE,
                                 plane * plane_pitch(skin_.pillars()) * sizeof(float), plane_bytes,
                                 bytes.data() + plane * plane_bytes);
  }
  slot.queue.enqueueReadBuffer(slot.status.buffer, CL_TRUE, 0, skin_.pillars(),
                               bytes.data() + planes * plane_bytes);
  return bytes;
}

EmptyLaunch::EmptyLaunch(const Device& device) : EmptyLaunch(OpenedDevice(device)) {}

EmptyLaunch::EmptyLaunch(const OpenedDevice& opened)
    : queue_(opened.context, opened.device),
      kernel_(opened.program(copy_source({}, 1, kCopyKinds[0])), "empty") {}

void EmptyLaunch::run(int launches) {
  for (int i = 0; i < launches; ++i) {
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(1), cl::NullRange);
    queue_.finish();
  }
}

}  // namespace pillarfield::bench
