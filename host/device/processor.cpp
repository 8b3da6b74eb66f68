#include "pillarfield/processor.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "device/kernel_source.h"
#include "device/lane_slot.h"
#include "device/opencl_slot.h"
#include "device/slot_scheduler.h"
#include "pillarfield/error.h"
#include "pillarfield/tuning.h"
#include "skin/quads.h"
#include "solve/activation_thresholds.h"
#include "solve/curvature_follower.h"
#include "solve/drift_follower.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

constexpr int kMaxFramesInFlight = static_cast<int>(kMostSlots);
constexpr std::size_t kMostUnpackingThreads = 8;  ///< they wait for the host's memory
constexpr const char* kSubmit = "Processor::submit";
constexpr std::chrono::milliseconds kCompileNotice{300};  ///< wait without a message

void check_options(const Processor::Options& options, const ProcessorTuning& tuning) {
  if (options.frames_in_flight < 1 || options.frames_in_flight > kMaxFramesInFlight) {
    throw Error("Processor", fmt::format("frames_in_flight is {}", options.frames_in_flight),
                fmt::format("it must lie in [1, {}]", kMaxFramesInFlight));
  }
  if (const int lanes = tuning.lanes; lanes < 0 || lanes > 16 || (lanes & (lanes - 1)) != 0) {
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

/// True if stores may bypass the caches: of sensels without pillars, two rows are written at once,
/// each of which must begin on a cache line.
bool rows_are_aligned(const Skin& skin) {
  constexpr std::uint32_t kFloatsOfLine = 16;
  return skin.has_pillars() || skin.cols % kFloatsOfLine == 0;
}

/// The speed paths with automatic choices resolved.
SpeedPaths decide_paths(const Device& device, const SolverPlan& plan,
                        const Processor::Options& options, const ProcessorTuning& tuning) {
  SpeedPaths paths = tuning.paths;
  if (paths.stores == Stores::cached || !rows_are_aligned(plan.skin)) {
    paths.stores = Stores::cached;
    return paths;
  }
  if (paths.stores != Stores::automatic) return paths;
  paths.stores = Stores::cached;
  if (device.state().is_host()) return paths;
  const std::size_t bytes = ResultLayout(plan, 0).bytes;
  const auto cache = device.state().device.getInfo<CL_DEVICE_GLOBAL_MEM_CACHE_SIZE>();
  const std::size_t all = bytes * static_cast<std::size_t>(options.frames_in_flight);
  if (cache != 0 && all > cache) paths.stores = Stores::streaming;
  return paths;
}

std::string line_on_compiling(const DeviceInfo& device) {
  if (!device.kernel_cache.empty()) {
    return fmt::format("Compiling the kernels for {}; the next start finds them in {}", device.name,
                       device.kernel_cache);
  }
  if (device.kernels_not_kept.empty()) return "Compiling the kernels for " + device.name;
  return fmt::format("Compiling the kernels for {}, as at every start: {}", device.name,
                     device.kernels_not_kept);
}

/// Calls a function from its own thread after a delay, unless the object is destroyed before.
class LateCall {
 public:
  /// An empty `function` is not called.
  LateCall(std::chrono::milliseconds delay, std::function<void()> function) {
    if (!function) return;
    thread_.emplace([delay, call = std::move(function)](const std::stop_token& ended) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any nothing;
      nothing.wait_for(lock, ended, delay, [] { return false; });
      if (!ended.stop_requested()) call();
    });
  }

 private:
  std::optional<std::jthread> thread_;  ///< ends with the object
};

[[noreturn]] void throw_no_slot(const SlotScheduler& scheduler) {
  if (scheduler.pinned() == 0) {
    throw Error(kSubmit, fmt::format("all {} frames are in flight", scheduler.slots()),
                "receive() one first, or set more frames_in_flight");
  }
  throw Error(kSubmit,
              fmt::format("of {} frames {} are in flight and {} are pinned", scheduler.slots(),
                          scheduler.in_flight(), scheduler.pinned()),
              "receive() or unpin a frame first, or set more frames_in_flight");
}

/// Threads beside a device: the compute units of one that is the host's processor.
std::size_t threads_beside(const Device::State& device) {
  const bool is_cpu =
      !device.is_host() && device.device.getInfo<CL_DEVICE_TYPE>() == CL_DEVICE_TYPE_CPU;
  const std::size_t threads = is_cpu ? device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()
                                     : std::thread::hardware_concurrency();
  return std::max<std::size_t>(threads, 1);
}

/// The program of the host for a plan; nothing on an OpenCL device.
std::optional<LaneSettings> lane_settings(const Device& device, const SolverPlan& plan, int lanes) {
  if (!device.state().is_host()) return std::nullopt;
  return LaneSettings(plan, lanes != 0 ? lanes : device.info().lanes);
}

DeviceCalibration calibration_of(const Device& device, const std::optional<LaneSettings>& lanes,
                                 const SolverPlan& plan, const SpeedPaths& paths) {
  if (lanes) return {{}, lane_calibration(plan, *lanes)};
  const bool has_activation = paths.skip_idle && has_activation_plane(plan);
  return {device.state().context,
          {plan, calibration_planes(plan, has_activation), plan.sensel_type}};
}

}  // namespace

struct Processor::State {
  State(const Device& opened, const SolverPlan& wanted, const Options& options,
        const ProcessorTuning& tuning)
      : device(opened),
        skin(wanted.skin),
        sensel_type(wanted.sensel_type),
        outputs{wanted.angles, wanted.uncertainty},
        shares_memory(decide_sharing(options.memory, opened)),
        paths(decide_paths(opened, wanted, options, tuning)),
        lanes(lane_settings(opened, wanted, tuning.lanes)),
        calibration(calibration_of(opened, lanes, wanted, paths)),
        scheduler(static_cast<std::size_t>(options.frames_in_flight)) {
    begin_states(wanted);
    if (lanes) {
      add_lane_slots(wanted, options.frames_in_flight);
    } else {
      add_opencl_slots(wanted, options.frames_in_flight, tuning);
      warm_up();
    }
    order.pace = baseline_pace(wanted);
    order.frame = 0;
  }

  /// Begins the states that frames of a plan leave to the next ones.
  void begin_states(const SolverPlan& wanted) {
    order.is_needed = has_memory_on_device(wanted);
    order.each_writes = wanted.baseline_rate || wanted.calibration.effects.memory;
    order.follows_baseline = wanted.baseline_rate.has_value();
    order.interval = static_cast<cl_uint>(wanted.baseline_interval);
    if (curvature) {
      curvature->set_plan(wanted);
    } else if (!wanted.calibration.bend_x.empty()) {
      curvature.emplace(wanted);
    }
    if (wanted.baseline_rate) drift.emplace(wanted);
    if (estimator_of(wanted) == Estimator::contact) {
      contacts.emplace(wanted, threads_beside(device.state()));
    }
  }

  void add_lane_slots(const SolverPlan& plan, int count) {
    if (lanes->division.bands > 1) {
      pool = std::make_unique<ThreadPool>(threads_beside(device.state()));
    }
    for (int i = 0; i < count; ++i) {
      slots.push_back(
          std::make_shared<LaneSlot>(plan, *lanes, calibration.planes(), order, pool.get()));
    }
  }

  void add_opencl_slots(const SolverPlan& plan, int count, const ProcessorTuning& tuning) {
    const int wanted_lanes = tuning.lanes != 0 ? tuning.lanes : device.info().lanes;
    settings.lanes = block_lanes(wanted_lanes, quad_cols(skin));
    settings.paths = paths;
    settings.program = device.state().program(kernel_source(plan, settings.lanes, settings.paths));
    if (!shares_memory) {
      settings.transfers = &transfers.emplace(
          std::min<std::size_t>(threads_beside(device.state()), kMostUnpackingThreads));
    }
    for (int i = 0; i < count; ++i) {
      slots.push_back(
          std::make_shared<OpenClSlot>(device.state(), plan, settings, calibration, order));
    }
  }

  /// Waits for the frames in flight, whose results stay as they are.
  void set_plan(const SolverPlan& plan) {
    if (!lanes) {
      settings.program =
          device.state().program(kernel_source(plan, settings.lanes, settings.paths));
    }
    for (const auto& slot : slots) slot->wait();
    if (lanes) lanes.emplace(plan, lanes->program->lanes);
    calibration = calibration_of(device, lanes, plan, paths);
    begin_states(plan);
    for (const auto& slot : slots) {
      if (lanes) {
        static_cast<LaneSlot&>(*slot).set_plan(plan, *lanes, calibration.planes());
      } else {
        static_cast<OpenClSlot&>(*slot).set_plan(plan, settings, calibration);
      }
    }
    order.pace = baseline_pace(plan);
    order.frame = 0;
  }

  void submit(const FrameView& frame);

  /// Solves an empty frame, so that no real frame waits while drivers finish compiling and create
  /// buffers at the first launch. The rate of the tare is still zero, and sensels end at rest.
  void warm_up() {
    const FrameBuffer frame(sensel_type, skin.rows, skin.cols);
    slots.front()->submit(frame.view(), curvature ? std::optional(Curvature{}) : std::nullopt, {});
    slots.front()->wait();
    calibration.clear_states();
  }

  Device device;
  Skin skin;
  SenselType sensel_type;
  std::array<bool, 2> outputs;  ///< angles, uncertainty
  bool shares_memory;
  SpeedPaths paths;
  std::optional<LaneSettings> lanes;  ///< of the host
  SlotSettings settings;              ///< of an OpenCL device
  std::unique_ptr<ThreadPool> pool;   ///< of the host, for large frames
  DeviceCalibration calibration;  ///< outlives the slots: a kernel does not retain its arguments
  FrameOrder order;               ///< outlives the slots
  std::optional<Transfers> transfers;  ///< of a device with its own memory; outlives the slots
  std::optional<CurvatureFollower> curvature;  ///< of a skin that may be bent
  std::optional<DriftFollower> drift;          ///< of a followed baseline
  std::optional<ContactStage> contacts;        ///< of the estimator `contact`
  std::vector<std::shared_ptr<Slot>> slots;    ///< a pinned one outlives the processor
  SlotScheduler scheduler;
  const Slot* last = nullptr;  ///< of the frame received last
};

struct Processor::PinnedResult::State {
  State(std::shared_ptr<const Slot> pinned, std::shared_ptr<ReturnedSlots> to, std::size_t index)
      : slot(std::move(pinned)), returned(std::move(to)), slot_index(index) {}
  ~State() { returned->give_back(slot_index); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::shared_ptr<const Slot> slot;
  std::shared_ptr<ReturnedSlots> returned;
  std::size_t slot_index;
};

Processor::PinnedResult::PinnedResult(std::unique_ptr<State> state) : state_(std::move(state)) {}
Processor::PinnedResult::PinnedResult(PinnedResult&&) noexcept = default;
Processor::PinnedResult& Processor::PinnedResult::operator=(PinnedResult&&) noexcept = default;
Processor::PinnedResult::~PinnedResult() = default;

std::span<const std::byte> Processor::PinnedResult::pages() const {
  return state_->slot->memory().pages();
}

Processor::Processor(const Device& device, const SolverPlan& plan, const Options& options,
                     const ProcessorTuning& tuning) {
  check_options(options, tuning);
  check(plan, "solver plan");
  const Device chosen = device.for_plan(plan);
  std::function<void()> notify;
  if (options.on_compiling && !chosen.state().is_host()) {
    notify = [&] { options.on_compiling(line_on_compiling(chosen.info())); };
  }
  const LateCall notice(kCompileNotice, notify);
  state_ = with_opencl_errors(
      chosen.info().name, [&] { return std::make_unique<State>(chosen, plan, options, tuning); });
}

Processor::Processor(const Device& device, const SolverPlan& plan, const Options& options)
    : Processor(device, plan, options, ProcessorTuning{}) {}

Processor::Processor(const Device& device, const SolverPlan& plan)
    : Processor(device, plan, Options{}) {}

Processor::~Processor() = default;
Processor::Processor(Processor&&) noexcept = default;
Processor& Processor::operator=(Processor&&) noexcept = default;

void Processor::State::submit(const FrameView& frame) {
  const std::optional<std::size_t> slot = scheduler.next();
  if (!slot) throw_no_slot(scheduler);
  try {
    std::optional<Curvature> bent;
    if (curvature) bent = curvature->follow(frame);
    const auto drifted = drift ? drift->follow(frame, bent) : single_precision::Drift{};
    with_opencl_errors(device.info().name, [&] { slots[*slot]->submit(frame, bent, drifted); });
  } catch (...) {
    scheduler.returned()->give_back(*slot);
    throw;
  }
  scheduler.submit(*slot);
}

void Processor::submit(const FrameView& frame) {
  check(frame, state_->skin, state_->sensel_type, kSubmit);
  state_->submit(frame);
}

FrameBuffer Processor::frame_buffer() {
  State& state = *state_;
  const Skin& skin = state.skin;
  if (!state.transfers) return {state.sensel_type, skin.rows, skin.cols};
  return with_opencl_errors(state.device.info().name, [&] {
    return state.transfers->frames.add(state.device.state().context, state.sensel_type, skin.rows,
                                       skin.cols);
  });
}

ForceFieldView Processor::receive() {
  if (in_flight() == 0) {
    throw Error("Processor::receive", "no frame is in flight", "submit() one first");
  }
  Slot& slot = *state_->slots[state_->scheduler.oldest()];
  with_opencl_errors(state_->device.info().name, [&] {
    slot.wait();
    if (state_->contacts) slot.resolve(*state_->contacts);
  });
  state_->scheduler.receive();
  state_->last = &slot;
  return slot.results();
}

std::optional<ForceFieldView> Processor::try_receive() {
  if (in_flight() == 0) return std::nullopt;
  const bool done = with_opencl_errors(state_->device.info().name, [&] {
    return state_->slots[state_->scheduler.oldest()]->is_done();
  });
  if (!done) return std::nullopt;
  return receive();
}

void Processor::set_plan(const SolverPlan& plan) {
  constexpr const char* kWhere = "Processor::set_plan";
  check(plan, kWhere);
  const Skin& skin = state_->skin;
  if (plan.skin.rows != skin.rows || plan.skin.cols != skin.cols ||
      plan.skin.layout != skin.layout || plan.sensel_type != state_->sensel_type ||
      plan.calibration.tare.empty() || !state_->calibration.planes().has_tare() ||
      state_->outputs != std::array{plan.angles, plan.uncertainty}) {
    throw Error(kWhere, "the plan has other frames or outputs, or no tare",
                "make another processor for it");
  }
  with_opencl_errors(state_->device.info().name, [&] { state_->set_plan(plan); });
}

Processor::PinnedResult Processor::pin() {
  const std::optional<std::size_t> slot = state_->scheduler.pin();
  if (!slot) {
    throw Error("Processor::pin", "there is no frame to pin",
                "call pin() once per frame, after receive() and before its slot is used again");
  }
  return PinnedResult(std::make_unique<PinnedResult::State>(state_->slots[*slot],
                                                            state_->scheduler.returned(), *slot));
}

FoundContacts Processor::contacts() const {
  if (state_->last == nullptr) return {};
  return state_->contacts ? state_->contacts->contacts() : state_->last->contacts();
}

Curvature Processor::curvature() const {
  return state_->curvature ? state_->curvature->curvature() : Curvature{};
}

int Processor::in_flight() const { return static_cast<int>(state_->scheduler.in_flight()); }

int Processor::pinned() const { return static_cast<int>(state_->scheduler.pinned()); }

std::vector<float> Processor::tare() const {
  return with_opencl_errors(state_->device.info().name, [&] {
    if (!state_->calibration.planes().has_tare()) return std::vector<float>();
    if (state_->order.left() != nullptr) state_->order.left.wait();
    return state_->calibration.tare(state_->skin.rows, state_->skin.cols);
  });
}

bool Processor::shares_memory() const { return state_->shares_memory; }

const Device& Processor::device() const { return state_->device; }

}  // namespace pillarfield
