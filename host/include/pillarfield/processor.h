#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// The path of frames and results to and from the device.
enum class Memory : std::uint8_t {
  automatic,  ///< shared if the device uses the host's memory, else staged
  shared,     ///< zero copy: the kernel reads the caller's frame and writes the result in place
  staged,     ///< copies to and from buffers of the device
};

/// Properties of a device, printed by `pillarfield info --devices`.
struct DeviceInfo {
  int index = 0;  ///< for open_device(); -1: the host without OpenCL
  std::string name;
  std::string platform;
  std::string version;         ///< of OpenCL and its driver: "OpenCL 3.0 PoCL HSTR: ..."
  std::string type;            ///< "CPU", "GPU", "accelerator", "other", or "host"
  int lanes = 1;               ///< pillars that a work-item solves at once
  bool shares_memory = false;  ///< uses the host's memory, so Memory::shared is possible
  std::string unsuitable;      ///< why open_device() skips it; empty if it is suitable
  /// Directory in which PoCL (OpenCL on the host's processor) caches compiled kernels. Empty for
  /// other drivers, whose caches are their own, and where PoCL has no cache.
  std::string kernel_cache;
  std::string kernels_not_kept;  ///< why PoCL has no cache; empty if it has one
};

/// Lists all OpenCL devices, suitable or not; the list may be empty.
///
/// The first call of list_devices() or open_device() chooses a private directory for PoCL's
/// compiled kernels and sets the environment variable POCL_CACHE_DIR
/// (docs/decisions/kernel_cache.md). No other thread may read or change the environment during that
/// call. Throws Error if POCL_CACHE_DIR names a directory that others can write, or that cannot be
/// written.
[[nodiscard]] std::vector<DeviceInfo> list_devices();

/// A device and the programs compiled for it so far. Copies share both.
class Device {
 public:
  /// Properties of the device. If none was named, opens the best OpenCL device: see open_device().
  [[nodiscard]] const DeviceInfo& info() const;

  /// The device that solves the frames of a plan: this one, if it was named. Else the host for a
  /// skin of up to 16,384 pillars (or 2 x 2 sensels; 65,536 if it solves forces alone from 8-bit
  /// readings without any correction), without opening OpenCL, and the best OpenCL device for
  /// others; the host if there is no such device. Throws Error in the cases of list_devices().
  [[nodiscard]] Device for_plan(const SolverPlan& plan) const;

  /// @cond internal
  struct State;
  class Best;
  explicit Device(std::shared_ptr<State> state) : state_(std::move(state)) {}
  explicit Device(std::shared_ptr<Best> best) : best_(std::move(best)) {}
  [[nodiscard]] State& state() const;
  /// @endcond

 private:
  std::shared_ptr<State> state_;
  std::shared_ptr<Best> best_;  ///< of a device that was not named
};

/// Opens a device:
///
///     ""        the host for small skins, else the best OpenCL device: see Device::for_plan()
///     "host"    the host: the kernels as vectors of the processor, without OpenCL and its compiler
///     "opencl"  the best suitable OpenCL device; GPUs come before CPUs
///     else      an OpenCL device by its index or by a part of its name (any case)
///
/// Throws Error, which lists every OpenCL device and why it was skipped, if none matches, and in
/// the cases of list_devices(); with an empty argument when the device is first needed.
[[nodiscard]] Device open_device(std::string_view wanted = {});

struct ProcessorTuning;  // tuning.h

/// Solves frames on a device according to a SolverPlan.
///
///     Processor processor(open_device(), plan);
///     processor.submit(frame.view());
///     ForceFieldView forces = processor.receive();
///
/// A processor is a ring of `frames_in_flight` slots. submit() starts a frame and returns at once;
/// receive() waits for the oldest frame in flight and returns a view of the slot's memory. Call
/// pin() to hold a result beyond the ring's lifetime, as a display does that draws it in place.
///
/// Results agree bit for bit with solve_on_host(), except for the estimator `paper`, which calls
/// library functions.
///
/// Threads: one at a time. A PinnedResult may be destroyed in any thread.
class Processor {
 public:
  struct Options {
    Memory memory = Memory::automatic;
    int frames_in_flight = 2;  ///< slots, 1 to 64
    /// Called at most once, from another thread, if compiling the kernels takes longer than 0.3 s,
    /// with a line of text for the user. It must not throw.
    std::function<void(const std::string& line)> on_compiling = {};
  };

  /// A result that is held beyond the ring's lifetime. Its slot is withheld from the ring until the
  /// PinnedResult is destroyed; that may happen in any thread, and after the processor is
  /// destroyed.
  class PinnedResult {
   public:
    PinnedResult(PinnedResult&&) noexcept;
    PinnedResult& operator=(PinnedResult&&) noexcept;
    ~PinnedResult();

    /// The memory block that holds all planes of the result. Its address and its size are multiples
    /// of 4096 bytes, and a slot always uses the same block.
    [[nodiscard]] std::span<const std::byte> pages() const;

   private:
    friend class Processor;
    struct State;
    explicit PinnedResult(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
  };

  /// Allocates all memory for the device that Device::for_plan() chooses. On an OpenCL device,
  /// compiles the kernels, or finds them compiled: seconds the first time, milliseconds later. On
  /// the host there is nothing to compile, and submit() solves the frame before it returns. Throws
  /// Error if the plan or the options are out of range or the device fails.
  Processor(const Device& device, const SolverPlan& plan, const Options& options);
  Processor(const Device& device, const SolverPlan& plan);
  /// For tests and benchmarks; include pillarfield/tuning.h.
  Processor(const Device& device, const SolverPlan& plan, const Options& options,
            const ProcessorTuning& tuning);
  ~Processor();
  Processor(Processor&&) noexcept;
  Processor& operator=(Processor&&) noexcept;

  /// Starts to solve a frame of the plan's size and type, with any row stride. With shared memory
  /// the caller must not change the frame until it is received; with staged memory it may change at
  /// once, unless it lies in a frame_buffer(). Throws Error if all slots are in flight or pinned,
  /// or the frame does not fit the plan.
  void submit(const FrameView& frame);

  /// A frame of the plan in memory that the device reads: submit() of its view() copies nothing.
  /// With staged memory that is pinned memory of the driver, so hold only as many as are in flight,
  /// and one more to fill. It must not change between submit() and receive(). It may be destroyed
  /// after the processor and in any thread, but not while its frame is in flight. Throws Error if
  /// the device has no such memory left.
  [[nodiscard]] FrameBuffer frame_buffer();

  /// Waits for the oldest frame in flight and returns its forces. The view stays valid until
  /// submit() reuses its slot, that is for as many further frames as there are slots that are not
  /// pinned, or for the life of a PinnedResult. Throws Error if no frame is in flight.
  [[nodiscard]] ForceFieldView receive();

  /// receive() if the oldest frame in flight is solved, without waiting; nothing if it is not or
  /// none is in flight. For control loops that must not block; the estimator `contact` still runs
  /// in this call.
  [[nodiscard]] std::optional<ForceFieldView> try_receive();

  /// Holds the result received last. Throws Error if there is none, it is held already, or a frame
  /// submitted since reuses its slot.
  [[nodiscard]] PinnedResult pin();

  /// The contacts of the frame received last, with their friction as the estimator `contact` found
  /// it; pass them to ContactTracker::update(), which then need not find them again. They stay
  /// valid until the next receive(). With other estimators `labels` is null; then the tracker skips
  /// what the solve found idle, as long as the frame's results are valid.
  [[nodiscard]] FoundContacts contacts() const;

  /// The tare after all frames submitted so far, [sensel rows, cols], counts; waits for them. It
  /// changes only with a baseline_rate and with the planes bend_x, bend_y and bend_xy. Empty if the
  /// plan has none of these and no tare.
  [[nodiscard]] std::vector<float> tare() const;

  /// Solves the frames submitted from now on by another plan, such as that of a LiveTare; waits for
  /// those in flight. The skin must be untouched: hysteresis and creep begin at rest, what the
  /// estimator `contact` has learnt is forgotten, and the tare of a bent skin is that at the
  /// present curvature. Compiles kernels where more changes than planes of the calibration. Throws
  /// Error if the plan is out of range, has other frames or outputs, or one of both plans has no
  /// tare.
  void set_plan(const SolverPlan& plan);

  /// The curvature of the skin in the frame submitted last, 1/mm, if the plan has the planes
  /// bend_x, bend_y and bend_xy: Processor follows it through the readings of untouched sensels.
  /// Else zero.
  [[nodiscard]] Curvature curvature() const;

  [[nodiscard]] int in_flight() const;       ///< frames submitted and not yet received
  [[nodiscard]] int pinned() const;          ///< results held now
  [[nodiscard]] bool shares_memory() const;  ///< whether frames and results stay in place
  [[nodiscard]] const Device& device() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
