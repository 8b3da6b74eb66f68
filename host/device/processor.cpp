#include "pillarfield/processor.h"

#include <fmt/format.h>

#include <string>

#include "device/block_lanes.h"
#include "device/slot.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr int kMaxFramesInFlight = 64;

void check_options(const Processor::Options& options) {
  if (options.frames_in_flight < 1 || options.frames_in_flight > kMaxFramesInFlight) {
    throw Error("Processor", fmt::format("frames_in_flight is {}", options.frames_in_flight),
                fmt::format("it must lie in [1, {}]", kMaxFramesInFlight));
  }
  const int lanes = options.lanes;
  if (lanes != 0 && lanes != 1 && lanes != 2 && lanes != 4 && lanes != 8 && lanes != 16) {
    throw Error("Processor", fmt::format("lanes is {}", lanes),
                "it must be 1, 2, 4, 8 or 16, or 0 for the device's own");
  }
}

bool decide_sharing(Memory memory, const Device& device) {
  if (memory == Memory::automatic) return device.info().shares_memory;
  if (memory == Memory::shared && !device.info().shares_memory) {
    throw Error(device.info().name, "this device does not share the host's memory",
                "use Memory::staged or Memory::automatic");
  }
  return memory == Memory::shared;
}

/// The paths with what the device leaves to choose decided.
SpeedPaths decide_paths(const Device& device, const SolverPlan& plan,
                        const Processor::Options& options) {
  SpeedPaths paths = options.paths;
  if (paths.stores != Stores::automatic) return paths;
  paths.stores = Stores::cached;
  if (plan.half_output) return paths;  // Half a cache line at a time is slow to stream.
  std::size_t bytes = 0;
  for (std::size_t plane = 0; plane < kAllPlanes; ++plane) {
    if (is_wanted(plan, plane)) bytes += plan.skin.pillars() * value_size(plan, plane);
  }
  const auto cache = device.state().device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  const std::size_t all = bytes * static_cast<std::size_t>(options.frames_in_flight);
  if (cache != 0 && all > cache) paths.stores = Stores::streaming;
  return paths;
}

}  // namespace

struct Processor::State {
  State(const Device& opened, const SolverPlan& wanted, const Options& options)
      : device(opened),
        skin(wanted.skin),
        sensel_type(wanted.sensel_type),
        half_output(wanted.half_output),
        shares_memory(decide_sharing(options.memory, opened)),
        calibration(opened.state().context, wanted, options.paths) {
    baseline.follows = wanted.baseline_rate.has_value();
    baseline.interval = static_cast<cl_uint>(wanted.baseline_interval);
    SlotSettings settings;
    settings.lanes =
        block_lanes(options.lanes != 0 ? options.lanes : device.info().lanes, skin.pillar_cols());
    settings.paths = decide_paths(device, wanted, options);
    settings.program =
        device.state().program(kernel_source(wanted, settings.lanes, settings.paths));
    settings.shares_memory = shares_memory;
    slots.reserve(static_cast<std::size_t>(options.frames_in_flight));
    for (int i = 0; i < options.frames_in_flight; ++i) {
      slots.emplace_back(device.state(), wanted, settings, calibration, baseline);
    }
    warm_up();
    baseline.rate = static_cast<float>(baseline_turn_rate(wanted));
    baseline.frame = 0;
  }

  /// Solves an empty frame: drivers finish compiling and make their buffers at the first launch,
  /// which no real frame shall wait for. The baseline's rate is still zero: the tare stays.
  void warm_up() {
    const FrameBuffer frame(sensel_type, skin.rows, skin.cols);
    slots.front().submit(frame.view());
    slots.front().wait();
  }

  [[nodiscard]] Slot& slot(std::uint64_t frame) { return slots[frame % slots.size()]; }

  Device device;
  Skin skin;
  SenselType sensel_type;
  bool half_output;
  bool shares_memory;
  CalibrationBuffers calibration;  ///< outlives the slots: a kernel does not retain its arguments
  Baseline baseline;               ///< as well
  std::vector<Slot> slots;
  std::uint64_t submitted = 0;
  std::uint64_t received = 0;
};

Processor::Processor(const Device& device, const SolverPlan& plan, const Options& options) {
  check_options(options);
  check(plan, "solver plan");
  state_ = with_opencl_errors(device.info().name,
                              [&] { return std::make_unique<State>(device, plan, options); });
}

Processor::Processor(const Device& device, const SolverPlan& plan)
    : Processor(device, plan, Options{}) {}

Processor::~Processor() = default;
Processor::Processor(Processor&&) noexcept = default;
Processor& Processor::operator=(Processor&&) noexcept = default;

void Processor::submit(const FrameView& frame) {
  const Skin& skin = state_->skin;
  if (frame.rows != skin.rows || frame.cols != skin.cols || frame.type != state_->sensel_type) {
    throw Error("Processor::submit",
                fmt::format("the frame is {} x {} {}", frame.rows, frame.cols, name_of(frame.type)),
                fmt::format("the plan says {} x {} {}", skin.rows, skin.cols,
                            name_of(state_->sensel_type)));
  }
  if (frame.data == nullptr || frame.row_stride < frame.cols) {
    throw Error("Processor::submit", "the frame has no data or rows that overlap",
                "row_stride counts readings and is at least cols");
  }
  if (state_->submitted - state_->received == state_->slots.size()) {
    throw Error("Processor::submit",
                fmt::format("all {} frames are in flight", state_->slots.size()),
                "receive() one first, or ask for more frames_in_flight");
  }
  with_opencl_errors(state_->device.info().name,
                     [&] { state_->slot(state_->submitted).submit(frame); });
  ++state_->submitted;
}

template <class Value>
FieldView<Value> Processor::receive_oldest() {
  if (state_->submitted == state_->received) {
    throw Error("Processor::receive", "no frame is in flight", "submit() one first");
  }
  Slot& slot = state_->slot(state_->received);
  with_opencl_errors(state_->device.info().name, [&] { slot.wait(); });
  ++state_->received;
  return slot.results<Value>();
}

ForceFieldView Processor::receive() {
  if (state_->half_output) {
    throw Error("Processor::receive", "the plan has half_output", "call receive_half()");
  }
  return receive_oldest<float>();
}

HalfFieldView Processor::receive_half() {
  if (!state_->half_output) {
    throw Error("Processor::receive_half", "the plan has no half_output",
                "call receive(), or set half_output");
  }
  return receive_oldest<Half>();
}

int Processor::in_flight() const { return static_cast<int>(state_->submitted - state_->received); }

std::vector<float> Processor::tare() const {
  return with_opencl_errors(state_->device.info().name, [&] {
    if (state_->calibration.tare() == nullptr) return std::vector<float>();
    std::vector<float> tare(state_->skin.sensels());
    const cl::CommandQueue queue(state_->device.state().context, state_->device.state().device);
    if (state_->baseline.left() != nullptr) state_->baseline.left.wait();
    queue.enqueueReadBuffer(state_->calibration.tare, CL_TRUE, 0, tare.size() * sizeof(float),
                            tare.data());
    return tare;
  });
}

bool Processor::shares_memory() const { return state_->shares_memory; }

const Device& Processor::device() const { return state_->device; }

}  // namespace pillarfield
