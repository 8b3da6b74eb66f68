#include "device/opencl_slot.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "device/kernel_source.h"
#include "skin/quads.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

/// Global and local size of a launch. With several lanes, a work-item solves a band of rows.
/// Several bands per compute unit balance the load; each is a work-group of its own, because
/// drivers group them badly (PoCL: 790 rows in one group). With one lane, work-items share a row,
/// and those of a group a tile of wires (PF_TILE_ITEMS).
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

/// Arguments of kernels/frame/*.cl; those from kPace on are of follow_baseline alone.
/// From kBendX on: the change of curvature of bend_tare.
enum Argument : cl_uint {
  kRaw,
  kCalibration,
  kResults,
  kLayout,
  kNumbers,
  kPace,
  kDrift,
  kFirstRow,
  kInterval
};
constexpr cl_uint kBendX = kPace;

}  // namespace

DeviceCalibration::DeviceCalibration(const cl::Context& context, CalibrationMemory planes)
    : planes_(std::move(planes)) {
  if (context() == nullptr || planes_.size() == 0) return;
  const auto device = context.getInfo<CL_CONTEXT_DEVICES>().front();
  const bool shared = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
  const cl_mem_flags use = shared ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
  buffer_ = {context, CL_MEM_READ_WRITE | use, planes_.size(), planes_.bytes()};
  if (!shared) planes_.free();
}

cl::CommandQueue DeviceCalibration::queue() const {
  const auto context = buffer_.getInfo<CL_MEM_CONTEXT>();
  return {context, context.getInfo<CL_CONTEXT_DEVICES>().front()};
}

void DeviceCalibration::clear_states() const {
  if (planes_.state_bytes() == 0) return;
  const cl::CommandQueue commands = queue();
  commands.enqueueFillBuffer(buffer_, cl_float{0}, planes_.size() - planes_.state_bytes(),
                             planes_.state_bytes());
  commands.finish();
}

std::vector<float> DeviceCalibration::tare(std::size_t rows, std::size_t cols) const {
  if (buffer_() == nullptr) return planes_.tare(rows, cols);
  std::vector<float> tare(rows * cols);
  const cl::size_type row = cols * sizeof(float);
  queue().enqueueReadBufferRect(buffer_, CL_TRUE, {0, 0, 0}, {0, 0, 0}, {row, rows, 1},
                                planes_.stride() * sizeof(float), 0, row, 0, tare.data());
  return tare;
}

OpenClSlot::OpenClSlot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
                       const DeviceCalibration& calibration, FrameOrder& order)
    : Slot(plan.skin, order), queue_(device.context, device.device) {
  const Launch solve(quad_rows(plan.skin), quad_cols(plan.skin), settings.lanes,
                     device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  global_ = solve.global;
  local_ = solve.local;
  const SlotLayout slot(plan, {settings.lanes, global_[1], settings.lanes > 1},
                        settings.paths.skip_idle, calibration.planes());
  if (slot.tiles_across > 0) tiles_ = {slot.tiles_across * local_.get()[0], slot.tiles_down};
  layout_ = slot.layout;
  memory_ = settings.transfers == nullptr
                ? shared_memory(device.context, slot.results)
                : staged_memory(device, queue_, plan, slot.results, *settings.transfers);
  if (padded_sensels(plan.skin) != plan.skin.sensels()) {
    const std::uint32_t rows = padded_rows(plan.skin);
    const std::uint32_t cols = padded_cols(plan.skin);
    padded_ = settings.transfers == nullptr
                  ? FrameBuffer(plan.sensel_type, rows, cols)
                  : settings.transfers->frames.add(device.context, plan.sensel_type, rows, cols);
  }
  make_kernels(plan, settings, calibration);
}

void OpenClSlot::make_kernels(const SolverPlan& plan, const SlotSettings& settings,
                              const DeviceCalibration& calibration) {
  auto numbers = plan_numbers(plan, solves_in_whole_numbers(plan, settings.lanes));
  numbers_ = {queue_.getInfo<CL_QUEUE_CONTEXT>(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR,
              sizeof(numbers), &numbers};
  const auto kernel = [&](const char* name) {
    cl::Kernel made(settings.program, name);
    made.setArg(kCalibration, calibration.buffer());
    made.setArg(kResults, memory_->results());
    made.setArg(kNumbers, numbers_);
    return made;
  };
  kernel_ = kernel("solve_frame");
  const SensorEffects& effects = plan.calibration.effects;
  if (effects.wires) wires_ = kernel("find_wires");
  if (!plan.calibration.bend_x.empty()) bend_ = kernel("bend_tare");
  if (effects.pillar_leak) unleak_ = kernel("remove_pillar_leak");
  if (effects.arm_mm) ratios_ = kernel("find_shear_ratios");
  if (corrects_forces(plan)) correct_ = kernel("correct_forces");
  if (!order().follows_baseline) return;
  follow_ = kernel("follow_baseline");
  follow_.setArg(kInterval, order().interval);
}

void OpenClSlot::set_plan(const SolverPlan& plan, const SlotSettings& settings,
                          const DeviceCalibration& calibration) {
  make_kernels(plan, settings, calibration);
  memory_->clear_flags(queue_);
}

OpenClSlot::~OpenClSlot() {
  try {
    memory_->release(queue_);
    queue_.finish();
  } catch (const cl::Error&) {
    // The result of the frame in flight is not used.
  }
}

/// The frame with all sensels of its quads, in `padded_` if some do not exist.
FrameView OpenClSlot::padded(const FrameView& frame) {
  if (!padded_) return frame;
  const FrameView view = padded_->view();
  const std::size_t reading = size_of(frame.type);
  for (std::size_t row = 0; row < frame.rows; ++row) {
    std::memcpy(padded_->bytes().data() + row * view.row_stride * reading,
                static_cast<const std::byte*>(frame.data) + row * frame.row_stride * reading,
                frame.cols * reading);
  }
  return view;
}

void OpenClSlot::submit(const FrameView& frame, const std::optional<Curvature>& bent,
                        const single_precision::Drift& drift) {
  const DeviceFrame on_device = memory_->upload(queue_, padded(frame));
  frame_ = on_device.readings;
  done_ = {};
  layout_.row_stride = on_device.row_stride;
  layout_.frame = ++order().frame;
  solve(bent, drift);
  if (unleak_() != nullptr) launch(unleak_, global_, local_);
  if (ratios_() != nullptr) launch(ratios_, global_, local_);
  if (correct_() != nullptr) launch(correct_, global_, local_);
  memory_->download(queue_);
  queue_.flush();
}

void OpenClSlot::launch(cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
                        const std::vector<cl::Event>* after, cl::Event* done) {
  kernel.setArg(kRaw, frame_);
  kernel.setArg(kLayout, layout_);
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, global, local, after, done);
}

void OpenClSlot::solve(const std::optional<Curvature>& bent, const single_precision::Drift& drift) {
  std::vector<cl::Event> before;
  if (order().is_needed && order().left() != nullptr) before.push_back(order().left);
  if (bent) {
    for (cl::Event& reader : order().readers) {
      if (reader() != nullptr) before.push_back(std::exchange(reader, {}));
    }
    bend_.setArg(kBendX, static_cast<float>(bent->x));
    bend_.setArg(kBendX + 1, static_cast<float>(bent->y));
    bend_.setArg(kBendX + 2, static_cast<float>(bent->xy));
    launch(bend_, global_, local_, &before, &order().left);
    before.clear();
  }
  // Tares and activation thresholds may change from frame to frame.
  if (wires_() != nullptr) {
    launch(wires_, tiles_, local_, &before);
    before.clear();
  }
  if (!order().is_needed) return launch(kernel_, global_, local_);
  cl::Event* const left =
      order().each_writes ? &order().left : &order().readers[order().frame % kMostSlots];
  launch(kernel_, global_, local_, &before, order().follows_baseline ? nullptr : left);
  if (order().follows_baseline) {
    follow_.setArg(kPace, order().pace);
    follow_.setArg(kDrift, drift);
    follow_.setArg(kFirstRow, order().first_row());
    launch(follow_, global_, local_, nullptr, left);
  }
}

void OpenClSlot::wait() {
  queue_.finish();
  if (memory_->fetch_rest(queue_)) queue_.finish();
  memory_->unpack();
}

bool OpenClSlot::is_done() {
  if (done_() == nullptr) {
    queue_.enqueueMarkerWithWaitList(nullptr, &done_);
    queue_.flush();
  }
  if (done_.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() > CL_COMPLETE) return false;
  if (!memory_->fetch_rest(queue_)) return true;
  done_ = {};
  queue_.flush();
  return false;
}

}  // namespace pillarfield
