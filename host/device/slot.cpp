#include "device/slot.h"

#include <algorithm>
#include <cstring>

#include "solve/wake_levels.h"

namespace pillarfield {
namespace {

/// A plane of calibration, copied to the device; a null buffer where it is empty.
template <class Value>
cl::Buffer plane_buffer(const cl::Context& context, const std::vector<Value>& plane) {
  if (plane.empty()) return {};
  void* const values = const_cast<Value*>(plane.data());  // Only read, but OpenCL wants it so.
  return {context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, plane.size() * sizeof(Value), values};
}

bool shares_memory(const cl::Context& context) {
  const auto devices = context.getInfo<CL_CONTEXT_DEVICES>();
  return devices.front().getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
}

/// The same for a plane that every frame goes through: in large pages, which `memory` keeps, where
/// the device shares the host's memory.
template <class Value>
cl::Buffer large_plane_buffer(const cl::Context& context, const std::vector<Value>& plane,
                              std::vector<LargePages>& memory) {
  if (plane.empty() || !shares_memory(context)) return plane_buffer(context, plane);
  const std::size_t bytes = plane.size() * sizeof(Value);
  memory.push_back(allocate_large_pages(bytes));
  std::memcpy(memory.back().get(), plane.data(), bytes);
  return {context, CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, bytes, memory.back().get()};
}

/// Levels as readings of the plan's type.
template <class Reading>
std::vector<Reading> as_readings(const std::vector<float>& levels) {
  return {levels.begin(), levels.end()};
}

cl::Buffer wake_buffer(const cl::Context& context, const SolverPlan& plan,
                       std::vector<LargePages>& memory) {
  const std::vector<float> levels = wake_levels(plan);
  switch (plan.sensel_type) {
    case SenselType::u8:
      return large_plane_buffer(context, as_readings<std::uint8_t>(levels), memory);
    case SenselType::u16:
      return large_plane_buffer(context, as_readings<std::uint16_t>(levels), memory);
    case SenselType::f32:
      break;
  }
  return large_plane_buffer(context, levels, memory);
}

/// Work-items, and their grouping. Where a work-item solves several pillars at once it takes a band
/// of rows; there are a few bands for each compute unit, so that none waits long for the last, and
/// they are work-groups of their own, since drivers have other ideas (PoCL makes a single group of
/// 790 rows). Elsewhere a row is spread over work-items.
struct Launch {
  Launch(std::uint32_t rows, std::uint32_t cols, int lanes, cl_uint compute_units) {
    constexpr std::size_t kGroup = 64;
    constexpr std::size_t kBandsPerUnit = 8;
    if (lanes > 1) {
      global = cl::NDRange(1, std::min<std::size_t>(rows, kBandsPerUnit * compute_units));
      local = cl::NDRange(1, 1);
      return;
    }
    global = cl::NDRange((cols + kGroup - 1) / kGroup * kGroup, rows);
    local = cl::NDRange(kGroup, 1);
  }
  cl::NDRange global;
  cl::NDRange local;
};

constexpr cl_uint kRawArgument = 0;
constexpr cl_uint kStrideArgument = 1;
constexpr cl_uint kRateArgument = 10;  // of follow_baseline
constexpr cl_uint kFirstRowArgument = 11;

}  // namespace

CalibrationBuffers::CalibrationBuffers(const cl::Context& context, const SolverPlan& plan,
                                       const SpeedPaths& paths)
    : tare(large_plane_buffer(context, plan.calibration.tare, memory)),
      gain(large_plane_buffer(context, plan.calibration.gain, memory)),
      dead_zone(large_plane_buffer(context, plan.calibration.dead_zone, memory)),
      mask(large_plane_buffer(context, plan.calibration.mask, memory)),
      noise(large_plane_buffer(context, plan.calibration.noise, memory)) {
  if (plan.baseline_rate && plan.calibration.tare.empty()) {
    tare = large_plane_buffer(context, std::vector<float>(plan.skin.sensels()), memory);
  }
  if (paths.skip_silent && has_wake_plane(plan)) wake = wake_buffer(context, plan, memory);
}

Slot::Slot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
           const CalibrationBuffers& calibration, Baseline& baseline)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      queue_(device.context, device.device),
      kernel_(settings.program, "solve_frame"),
      baseline_(&baseline) {
  const Launch launch(rows_, cols_, settings.lanes,
                      device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  global_ = launch.global;
  local_ = launch.local;
  const MarkLayout marks =
      settings.paths.skip_silent ? MarkLayout(plan, settings.lanes) : MarkLayout();
  memory_ = settings.shares_memory ? shared_memory(device.context, plan, marks)
                                   : staged_memory(device.context, queue_, plan, marks);
  cl_uint argument = kStrideArgument + 1;
  kernel_.setArg(argument++, cl_uint{rows_});
  kernel_.setArg(argument++, cl_uint{cols_});
  for (const cl::Buffer* plane : {&calibration.tare, &calibration.gain, &calibration.dead_zone,
                                  &calibration.mask, &calibration.noise, &calibration.wake}) {
    kernel_.setArg(argument++, *plane);
  }
  kernel_.setArg(argument++, cl_ulong{plan.skin.cols});
  kernel_.setArg(argument++, memory_->marks());
  for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
    kernel_.setArg(argument++, memory_->buffer(plane));
  }
  if (!baseline.follows) return;
  follow_ = cl::Kernel(settings.program, "follow_baseline");
  argument = kStrideArgument + 1;
  follow_.setArg(argument++, cl_uint{rows_});
  follow_.setArg(argument++, cl_uint{cols_});
  follow_.setArg(argument++, calibration.gain);
  follow_.setArg(argument++, calibration.mask);
  follow_.setArg(argument++, cl_ulong{plan.skin.cols});
  follow_.setArg(argument++, memory_->buffer(kStatus));
  follow_.setArg(argument++, calibration.tare);
  follow_.setArg(argument++, calibration.wake);
  follow_.setArg(kFirstRowArgument + 1, baseline.interval);
}

Slot::~Slot() {
  if (queue_() == nullptr) return;  // Moved from.
  try {
    queue_.finish();
  } catch (const cl::Error&) {
    // Nothing of the frame in flight is wanted any more.
  }
}

void Slot::submit(const FrameView& frame) {
  DeviceFrame on_device = memory_->take(queue_, frame);
  frame_ = on_device.readings;
  kernel_.setArg(kRawArgument, frame_);
  row_stride_ = on_device.row_stride;
  kernel_.setArg(kStrideArgument, row_stride_);
  memory_->release(queue_);
  if (baseline_->follows) {
    launch_in_order();
  } else {
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, global_, local_);
  }
  memory_->fetch(queue_);
  queue_.flush();
}

void Slot::launch_in_order() {
  std::vector<cl::Event> before;
  if (baseline_->left() != nullptr) before.push_back(baseline_->left);
  queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, global_, local_, &before);
  follow_.setArg(kRawArgument, frame_);
  follow_.setArg(kStrideArgument, row_stride_);
  follow_.setArg(kRateArgument, baseline_->rate);
  follow_.setArg(kFirstRowArgument, static_cast<cl_uint>(baseline_->frame % baseline_->interval));
  ++baseline_->frame;
  queue_.enqueueNDRangeKernel(follow_, cl::NullRange, global_, local_, nullptr, &baseline_->left);
}

void Slot::wait() { queue_.finish(); }

ForceFieldView Slot::results() const {
  const auto plane = [&](std::size_t which) -> std::span<const float> {
    const std::byte* const host = memory_->host(which);
    if (host == nullptr) return {};
    return {reinterpret_cast<const float*>(host), std::size_t{rows_} * cols_};
  };
  const auto* const status = reinterpret_cast<const std::uint8_t*>(memory_->host(kStatus));
  ForceFieldView forces = {rows_,
                           cols_,
                           plane(kShearX),
                           plane(kShearY),
                           plane(kNormal),
                           {status, std::size_t{rows_} * cols_},
                           plane(kMagnitude),
                           plane(kTheta),
                           plane(kPhi),
                           {}};
  std::size_t which = kUncertainty;
  for (auto& span : forces.uncertainty) span = plane(which++);
  return forces;
}

}  // namespace pillarfield
