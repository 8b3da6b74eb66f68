#include "device/slot.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "device/kernel_source.h"
#include "skin/quads.h"

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
/// From kBendX on: the change of curvature of bend_tare.
enum Argument : cl_uint {
  kRaw,
  kCalibration,
  kResults,
  kLayout,
  kRate,
  kDrift,
  kFirstRow,
  kInterval
};
constexpr cl_uint kBendX = kRate;

/// Tiles of a skin, across and down.
cl::NDRange tiles_of(const SolverPlan& plan, const WireCrosstalk& wires) {
  const auto tiles = [](std::size_t sensels, std::size_t tile) {
    return (sensels + tile - 1) / tile;
  };
  return {tiles(2 * std::size_t{quad_cols(plan.skin)}, wires.tile_cols),
          tiles(2 * std::size_t{quad_rows(plan.skin)}, wires.tile_rows)};
}

/// Floats of the rings of kernels/frame/neighbours.h.
std::size_t ring_floats(const SolverPlan& plan, const SlotSettings& settings, std::size_t bands) {
  if (!plan.calibration.effects.sensel_leak || settings.lanes == 1) return 0;
  constexpr std::size_t kRows = 3;  // PF_RING_ROWS
  const std::uint32_t cols = quad_cols(plan.skin);
  const auto lanes = static_cast<std::uint32_t>(settings.lanes);
  const std::size_t flags = kRows * blocks_of_row(cols, lanes);
  return bands *
         (4 * kRows * (std::size_t{cols} + 2) + (flags + sizeof(float) - 1) / sizeof(float));
}

/// Floats of the vectors of kernels/frame/wire_vectors.h.
std::size_t wire_floats(const SolverPlan& plan, const cl::NDRange& tiles) {
  if (!plan.calibration.effects.wires) return 0;
  const std::size_t rows = 2 * std::size_t{quad_rows(plan.skin)};
  const std::size_t cols = 2 * std::size_t{quad_cols(plan.skin)};
  return 3 * rows * tiles[0] + cols * tiles[1];
}

single_precision::Layout layout_of(const SolverPlan& plan, const ResultLayout& results,
                                   const CalibrationMemory& calibration) {
  return {.row_stride = 0,
          .rows = quad_rows(plan.skin),
          .cols = quad_cols(plan.skin),
          .sensel_rows = plan.skin.rows,
          .sensel_cols = plan.skin.cols,
          .plane_stride = calibration.stride(),
          .plane_bytes = calibration.plane_bytes(),
          .result_bytes = results.plane_bytes,
          .status = results.status,
          .touched = results.status,
          .idle = results.bytes,
          .ring = results.scratch_begin(),
          .wires = results.scratch_begin(),
          .frame = 0,
          .forces = results.scratch_begin(),
          .ratios = results.scratch_begin()};
}

}  // namespace

Slot::Slot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
           const CalibrationMemory& calibration, FrameOrder& order)
    : rows_(plan.skin.element_rows()),
      cols_(plan.skin.element_cols()),
      queue_(device.context, device.device),
      order_(&order) {
  const Launch solve(quad_rows(plan.skin), quad_cols(plan.skin), settings.lanes,
                     device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
  global_ = solve.global;
  local_ = solve.local;
  ResultLayout results(plan, settings.paths.skip_idle ? settings.lanes : 0);
  if (const auto& wires = plan.calibration.effects.wires) tiles_ = tiles_of(plan, *wires);
  const std::size_t ring = ring_floats(plan, settings, global_[1]);
  const std::size_t forces = plan.calibration.effects.pillar_leak ? 3 * results.plane_bytes : 0;
  const std::size_t ratios = plan.calibration.effects.arm_mm ? 4 * results.plane_bytes : 0;
  const std::size_t floats = (ring + wire_floats(plan, tiles_)) * sizeof(float);
  const bool marks_touched = order.follows_baseline && !plan.skin.has_pillars();
  results.scratch = forces + ratios + floats + (marks_touched ? quads(plan.skin) : 0);
  memory_ = settings.shares_memory ? shared_memory(device.context, results)
                                   : staged_memory(device.context, queue_, plan, results);
  layout_ = layout_of(plan, results, calibration);
  layout_.ratios += forces;
  layout_.ring += forces + ratios;
  layout_.wires += forces + ratios + ring * sizeof(float);
  if (marks_touched) layout_.touched = results.scratch_begin() + forces + ratios + floats;
  const auto kernel = [&](const char* name) {
    cl::Kernel made(settings.program, name);
    made.setArg(kCalibration, calibration.buffer());
    made.setArg(kResults, memory_->results());
    return made;
  };
  if (padded_sensels(plan.skin) != plan.skin.sensels()) {
    padded_.emplace(plan.sensel_type, padded_rows(plan.skin), padded_cols(plan.skin));
  }
  kernel_ = kernel("solve_frame");
  if (plan.calibration.effects.wires) wires_ = kernel("find_wires");
  const SensorEffects& effects = plan.calibration.effects;
  if (!plan.calibration.bend_x.empty()) bend_ = kernel("bend_tare");
  if (effects.pillar_leak) unleak_ = kernel("remove_pillar_leak");
  const bool derives = plan.angles || plan.uncertainty;
  if (effects.arm_mm) ratios_ = kernel("find_shear_ratios");
  if (effects.arm_mm || (effects.pillar_leak && derives)) correct_ = kernel("correct_forces");
  if (!order.follows_baseline) return;
  follow_ = kernel("follow_baseline");
  follow_.setArg(kInterval, order.interval);
}

Slot::~Slot() {
  if (queue_() == nullptr) return;  // Moved from.
  try {
    memory_->release(queue_);
    queue_.finish();
  } catch (const cl::Error&) {
    // The result of the frame in flight is not used.
  }
}

/// The frame with all sensels of its quads, in `padded_` if some do not exist.
FrameView Slot::padded(const FrameView& frame) {
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

void Slot::submit(const FrameView& frame, const std::optional<Curvature>& bent,
                  const single_precision::Drift& drift) {
  const DeviceFrame on_device = memory_->upload(queue_, padded(frame));
  frame_ = on_device.readings;
  done_ = {};
  layout_.row_stride = on_device.row_stride;
  layout_.frame = ++order_->frame;
  solve(bent, drift);
  if (unleak_() != nullptr) launch(unleak_, global_, local_);
  if (ratios_() != nullptr) launch(ratios_, global_, local_);
  if (correct_() != nullptr) launch(correct_, global_, local_);
  memory_->download(queue_);
  queue_.flush();
}

void Slot::launch(cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
                  const std::vector<cl::Event>* after, cl::Event* done) {
  kernel.setArg(kRaw, frame_);
  kernel.setArg(kLayout, layout_);
  queue_.enqueueNDRangeKernel(kernel, cl::NullRange, global, local, after, done);
}

void Slot::solve(const std::optional<Curvature>& bent, const single_precision::Drift& drift) {
  std::vector<cl::Event> before;
  if (order_->is_needed && order_->left() != nullptr) before.push_back(order_->left);
  if (bent) {
    for (cl::Event& reader : order_->readers) {
      if (reader() != nullptr) before.push_back(std::exchange(reader, {}));
    }
    bend_.setArg(kBendX, static_cast<float>(bent->x));
    bend_.setArg(kBendX + 1, static_cast<float>(bent->y));
    bend_.setArg(kBendX + 2, static_cast<float>(bent->xy));
    launch(bend_, global_, local_, &before, &order_->left);
    before.clear();
  }
  // Tares and activation thresholds may change from frame to frame.
  if (wires_() != nullptr) {
    launch(wires_, tiles_, {1, 1}, &before);
    before.clear();
  }
  if (!order_->is_needed) return launch(kernel_, global_, local_);
  cl::Event* const left =
      order_->each_writes ? &order_->left : &order_->readers[order_->frame % kMostSlots];
  launch(kernel_, global_, local_, &before, order_->follows_baseline ? nullptr : left);
  if (order_->follows_baseline) {
    follow_.setArg(kRate, order_->rate);
    follow_.setArg(kDrift, drift);
    follow_.setArg(kFirstRow, static_cast<cl_uint>((order_->frame - 1) % order_->interval));
    launch(follow_, global_, local_, nullptr, left);
  }
}

void Slot::wait() { queue_.finish(); }

bool Slot::is_done() {
  if (done_() == nullptr) {
    queue_.enqueueMarkerWithWaitList(nullptr, &done_);
    queue_.flush();
  }
  return done_.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;
}

ForceFieldView Slot::results() const {
  const std::size_t elements = std::size_t{rows_} * cols_;
  ForceFieldView forces;
  forces.rows = rows_;
  forces.cols = cols_;
  forces.status = {memory_->status(), elements};
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    const auto* const values = reinterpret_cast<const float*>(memory_->plane(i));
    if (values != nullptr) plane_of(forces, i) = {values, elements};
  }
  return forces;
}

}  // namespace pillarfield
