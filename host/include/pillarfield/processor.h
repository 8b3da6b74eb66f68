#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// How frames and results reach the device.
enum class Memory : std::uint8_t {
  automatic,  ///< shared where the device uses the host's memory, staged elsewhere
  shared,     ///< zero copy: the kernel reads the caller's frame and writes the result in place
  staged,     ///< copies to and from buffers of the device
};

/// One line about an OpenCL device, as `pillarfield info --devices` prints it.
struct DeviceInfo {
  int index = 0;  ///< for open_device
  std::string name;
  std::string platform;
  std::string type;  ///< "CPU", "GPU", "accelerator" or "other"
  int lanes = 1;     ///< pillars a work-item solves at once
  bool shares_memory = false;
  std::string unsuitable;  ///< why it is passed over; empty where it is suitable
  /// The directory in which PoCL, OpenCL on the host's processor, keeps compiled kernels for other
  /// processes; empty where it does not, for which `kernels_not_kept` says why, and of other
  /// drivers, which keep them where they please.
  std::string kernel_cache;
  std::string kernels_not_kept;
};

/// All OpenCL devices, suitable or not; none is no error. The first call of this function or of
/// open_device() chooses a private directory for PoCL's compiled kernels and sets POCL_CACHE_DIR to
/// it (docs/decisions/kernel_cache.md): no other thread may read or change the environment
/// meanwhile. Throws Error where $POCL_CACHE_DIR names one that others can write, or that cannot be
/// written.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// An open device with the programs compiled for it so far. Copies share both.
class Device {
 public:
  [[nodiscard]] const DeviceInfo& info() const;

  struct State;
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  [[nodiscard]] State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

/// Opens a device by index or by a part of its name (any case); empty: the best suitable one, GPUs
/// before CPUs. Throws Error that lists every device and why it was passed over, and as
/// list_devices() does.
[[nodiscard]] Device open_device(std::string_view index_or_name = {});

/// How results are written.
enum class Stores : std::uint8_t {
  automatic,  ///< streaming where the results of all slots exceed the caches, else cached
  cached,
  streaming,  ///< past the caches, where the device's compiler can
};

/// Ways to the same results, bit for bit, that differ in speed.
struct SpeedPaths {
  /// Blocks of pillars whose sensels are all silent, and were so when their slot was last written,
  /// are not solved again.
  bool skip_silent = true;
  Stores stores = Stores::automatic;
};

/// The OpenCL C that is compiled for a plan on a device with so many lanes, complete. Stores are
/// streaming only where `paths` says so.
[[nodiscard]] std::string kernel_source(const SolverPlan& plan, int device_lanes,
                                        const SpeedPaths& paths = {});

/// The stages of a plan, in their order, one name each: those of kernel_source, and of the host.
[[nodiscard]] std::vector<std::string> kernel_stages(const SolverPlan& plan);

/// Solves frames on a device, by the estimator and with the stages that a plan names.
///
/// A ring of `frames_in_flight` slots: submit() starts a frame and returns; receive() waits for the
/// oldest. Not for use by two threads at once, save that a Kept may be given back from any thread.
///
/// A result that shall stay longer than the ring lets it is kept: keep() takes its slot out of the
/// ring, nothing is written there, and other frames make do with the slots that are left. So a
/// display may look at one result in place, without a copy, while others are solved.
///
///     Processor processor(open_device(), plan);
///     processor.submit(frame.view());
///     ForceFieldView forces = processor.receive();
class Processor {
 public:
  struct Options {
    Memory memory = Memory::automatic;
    int frames_in_flight = 2;  ///< 1..64
    int lanes = 0;  ///< pillars that a work-item solves at once: 1, 2, 4, 8 or 16; 0: DeviceInfo's;
                    ///< fewer where a row of the skin is shorter
    SpeedPaths paths = {};
    /// Called at most once, from another thread, where the constructor takes longer than a moment,
    /// as when kernels are compiled for the first time: with a line that says so to a user. May not
    /// throw.
    std::function<void(const std::string& line)> on_compiling = {};
  };

  /// A result that was kept. Its spans and its pages stay as they are until it is destroyed, which
  /// gives its slot back. That may happen in any thread, while the processor solves, or after it is
  /// gone: its memory then goes with the last Kept. A result is read before it is given back.
  class Kept {
   public:
    Kept(Kept&&) noexcept;
    Kept& operator=(Kept&&) noexcept;
    ~Kept();

    /// One block, on a boundary of 4096 bytes and of a multiple of them, that holds all planes of
    /// the result. A slot always gives the same one.
    [[nodiscard]] std::span<const std::byte> pages() const;

   private:
    friend class Processor;
    struct State;
    explicit Kept(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
  };

  /// Compiles (or finds compiled) the kernel and makes all buffers. Throws Error on a plan out of
  /// range or a device that fails.
  Processor(const Device& device, const SolverPlan& plan, const Options& options);
  Processor(const Device& device, const SolverPlan& plan);
  ~Processor();
  Processor(Processor&&) noexcept;
  Processor& operator=(Processor&&) noexcept;

  /// Starts solving a frame of the plan's size and type, of any row stride. With shared memory the
  /// frame must stay as it is until it was received; with staged memory it may change at once.
  /// Throws Error when all slots are in flight or kept, or the frame does not fit the plan.
  void submit(const FrameView& frame);

  /// Waits for the oldest frame in flight. Its spans stay valid until as many frames were submitted
  /// after it as there are slots that are not kept, or for as long as it is kept. Throws Error when
  /// none is in flight.
  [[nodiscard]] ForceFieldView receive();

  /// Keeps the frame last received. Throws Error where none was received, it is kept already, or a
  /// frame that was submitted since took its slot.
  [[nodiscard]] Kept keep();

  /// The contacts of the frame last received and what the estimator `contact` believes of their
  /// friction: with them ContactTracker need not look. They stay until the next frame is received,
  /// also where this one is kept. Nothing with other estimators, and before the first frame.
  [[nodiscard]] FoundContacts contacts() const;

  /// The tare [sensel rows, cols] as the frames submitted so far leave it, in counts; waits for
  /// them. Empty where the plan has none and follows none.
  [[nodiscard]] std::vector<float> tare() const;

  [[nodiscard]] int in_flight() const;
  [[nodiscard]] int kept() const;  ///< results that are kept now
  [[nodiscard]] bool shares_memory() const;
  [[nodiscard]] const Device& device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
