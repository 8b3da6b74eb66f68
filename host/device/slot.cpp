#include "device/slot.h"

#include <algorithm>

namespace pillarfield {
namespace {

/// Global and local size of a launch. With several lanes, a work-item solves a band of rows.
/// Several bands per compute unit balance the load; each is a work-group of its own, because
/// drivers group them badly (PoCL: 790 rows in one group). With one lane, work-items share a row.
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

/// Arguments of kernels/frame/*.cl; those from kRate on are of follow_baseline alone.
enum Argument : cl_uint { kRaw, kCalibration, kResults, kLayout, kRate, kFirstRow, kInterval };

single_precision::Layout layout_of(const SolverPlan& plan, const ResultLayout& results,
                                   const CalibrationMemory& calibration) {
  return {.row_stride = 0,
          .rows = plan.skin.pillar_rows(),
          .cols = plan.skin.pillar_cols(),
          .plane_stride = plan.skin.cols,
          .plane_bytes = calibration.plane_bytes(),
          .result_bytes = results.plane_bytes,
          .status = results.status,
          .idle = results.bytes};
}

}  // namespace

Slot::Slot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
           const CalibrationMemory& calibration, Baseline& baseline)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      queue_(device.context, device.device),
      kernel_(settings.program, "solve_frame"),
      baseline_(&baseline) {
  const Launch launch(rows_, cols_, settings.lanes,
                      device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  global_ = launch.global;
  local_ = launch.local;
  const ResultLayout results(plan, settings.paths.skip_idle ? settings.lanes : 0);
  memory_ = settings.shares_memory ? shared_memory(device.context, results)
                                   : staged_memory(device.context, queue_, plan, results);
  layout_ = layout_of(plan, results, calibration);
  kernel_.setArg(kCalibration, calibration.buffer());
  kernel_.setArg(kResults, memory_->results());
  if (!baseline.follows) return;
  follow_ = cl::Kernel(settings.program, "follow_baseline");
  follow_.setArg(kCalibration, calibration.buffer());
  follow_.setArg(kResults, memory_->results());
  follow_.setArg(kInterval, baseline.interval);
}

Slot::~Slot() {
  if (queue_() == nullptr) return;  // Moved from.
  try {
    queue_.finish();
  } catch (const cl::Error&) {
    // The result of the frame in flight is not used.
  }
}

void Slot::submit(const FrameView& frame) {
  const DeviceFrame on_device = memory_->upload(queue_, frame);
  frame_ = on_device.readings;
  layout_.row_stride = on_device.row_stride;
  kernel_.setArg(kRaw, frame_);
  kernel_.setArg(kLayout, layout_);
  if (baseline_->follows) {
    launch_in_order();
  } else {
    queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, global_, local_);
  }
  memory_->download(queue_);
  queue_.flush();
}

void Slot::launch_in_order() {
  std::vector<cl::Event> before;
  if (baseline_->left() != nullptr) before.push_back(baseline_->left);
  queue_.enqueueNDRangeKernel(kernel_, cl::NullRange, global_, local_, &before);
  follow_.setArg(kRaw, frame_);
  follow_.setArg(kLayout, layout_);
  follow_.setArg(kRate, baseline_->rate);
  follow_.setArg(kFirstRow, static_cast<cl_uint>(baseline_->frame % baseline_->interval));
  ++baseline_->frame;
  queue_.enqueueNDRangeKernel(follow_, cl::NullRange, global_, local_, nullptr, &baseline_->left);
}

void Slot::wait() { queue_.finish(); }

ForceFieldView Slot::results() const {
  const std::size_t pillars = std::size_t{rows_} * cols_;
  ForceFieldView forces;
  forces.rows = rows_;
  forces.cols = cols_;
  forces.status = {memory_->status(), pillars};
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto* const values = reinterpret_cast<const float*>(memory_->plane(i));
    if (values != nullptr) plane_of(forces, i) = {values, pillars};
  }
  return forces;
}

}  // namespace pillarfield
