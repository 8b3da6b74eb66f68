#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "device/calibration_memory.h"
#include "device/contact_stage.h"
#include "device/device_state.h"
#include "device/slot_memory.h"
#include "device/slot_scheduler.h"
#include "pillarfield/tuning.h"

namespace pillarfield {

/// What frames leave to the next one on the device: the tare of a followed baseline or of a bent
/// skin, and the states of sensels. Frames in flight are then ordered: a reader waits for the last
/// writer, a writer for all readers.
struct FrameOrder {
  bool is_needed = false;
  bool each_writes = false;  ///< every frame; else those with a change of curvature
  bool follows_baseline = false;
  float rate = 0;           ///< rate of the tare per update of a row
  cl_uint interval = 1;     ///< frames between updates of a pillar row
  std::uint64_t frame = 0;  ///< number of frames submitted
  cl::Event left;           ///< completion of the last that wrote; null before the first
  std::array<cl::Event, kMostSlots> readers;  ///< the last frames, which read what that left
};

/// Settings that all slots of a processor share.
struct SlotSettings {
  cl::Program program;
  int lanes = 1;
  bool shares_memory = false;
  SpeedPaths paths;
};

/// One frame in flight: a queue of its own, a kernel with its arguments, and memory.
class Slot {
 public:
  Slot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
       const CalibrationMemory& calibration, FrameOrder& order);
  ~Slot();
  Slot(Slot&&) noexcept = default;
  Slot& operator=(Slot&&) noexcept = default;
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  /// Starts solving the frame, after a change of the skin's curvature if given; `drift` is that of
  /// touched tares after it. The slot must not be in flight.
  void submit(const FrameView& frame, const std::optional<Curvature>& bent = {},
              const single_precision::Drift& drift = {});

  void wait();

  /// Whether wait() would return at once.
  [[nodiscard]] bool is_done();

  /// Estimates the ambiguous pillars of the frame, after wait().
  void resolve(ContactStage& contacts) { contacts.resolve(*memory_); }

  /// Results of the frame, after wait().
  [[nodiscard]] ForceFieldView results() const;

  [[nodiscard]] std::span<const std::byte> pages() const { return memory_->pages(); }

 private:
  FrameView padded(const FrameView& frame);
  /// Starts a kernel on the frame.
  void launch(cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
              const std::vector<cl::Event>* after = nullptr, cl::Event* done = nullptr);
  /// Solves the frame; after the frame before, where there is an order.
  void solve(const std::optional<Curvature>& bent, const single_precision::Drift& drift);

  std::uint32_t rows_;  ///< pillars
  std::uint32_t cols_;
  cl::NDRange global_;
  cl::NDRange local_;
  cl::CommandQueue queue_;
  cl::Kernel kernel_;
  cl::Kernel wires_;  ///< null without crosstalk of wires
  cl::NDRange tiles_;
  cl::Kernel unleak_;   ///< null without leak between pillars
  cl::Kernel ratios_;   ///< null without off-centre pressure
  cl::Kernel correct_;  ///< null where no force is corrected by its neighbours
  cl::Kernel bend_;     ///< null where the skin is not bent
  cl::Kernel follow_;   ///< null without a baseline rate
  FrameOrder* order_;
  cl::Event done_;  ///< behind the frame, once is_done() was asked for it; else null
  std::optional<FrameBuffer> padded_;  ///< of a frame that lacks sensels of its last quads
  cl::Buffer frame_;                   ///< keeps the frame in flight alive
  single_precision::Layout layout_{};
  std::unique_ptr<SlotMemory> memory_;
};

}  // namespace pillarfield
