#pragma once

#include <array>
#include <memory>
#include <vector>

#include "device/contact_stage.h"
#include "device/device_state.h"
#include "device/large_pages.h"
#include "device/slot_memory.h"
#include "pillarfield/tuning.h"

namespace pillarfield {

/// The calibration planes of a plan on the device; null where the plan has none.
struct CalibrationBuffers {
  CalibrationBuffers(const cl::Context& context, const SolverPlan& plan, const SpeedPaths& paths);

  std::vector<LargePages> memory;  ///< of the planes, where the device uses the host's
  cl::Buffer tare;
  cl::Buffer gain;
  cl::Buffer dead_zone;
  cl::Buffer mask;
  cl::Buffer noise;
  cl::Buffer wake;  ///< readings; follows the tare
};

/// How the tare follows the readings from frame to frame, where a plan asks for it. Each frame
/// needs the tare that the one before left, so frames in flight wait for each other.
struct Baseline {
  bool follows = false;
  float rate = 0;           ///< of a row whose turn it is
  cl_uint interval = 1;     ///< frames from one turn of a pillar row to the next
  std::uint64_t frame = 0;  ///< counts those submitted
  cl::Event left;           ///< the last frame's tare is written; null before the first
};

/// What the slots of a processor have in common.
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
       const CalibrationBuffers& calibration, Baseline& baseline);
  ~Slot();
  Slot(Slot&&) noexcept = default;
  Slot& operator=(Slot&&) noexcept = default;
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  /// Starts the frame; the slot must not be in flight.
  void submit(const FrameView& frame);

  /// Waits for it.
  void wait();

  /// Estimates what the direct solve left ambiguous, after wait().
  void resolve(ContactStage& contacts) { contacts.resolve(*memory_); }

  /// What it became, after wait(). `Value` is that of the plan's results: float or Half.
  template <class Value>
  [[nodiscard]] FieldView<Value> results() const;

  /// The block of whole pages that the results lie in.
  [[nodiscard]] std::span<const std::byte> pages() const { return memory_->pages(); }

 private:
  /// Solves and follows after the frame before has.
  void launch_in_order();

  std::uint32_t rows_;  ///< pillars
  std::uint32_t cols_;
  cl::NDRange global_;
  cl::NDRange local_;
  cl::CommandQueue queue_;
  cl::Kernel kernel_;
  cl::Kernel follow_;  ///< null where the baseline stays
  Baseline* baseline_;
  cl::Buffer frame_;  ///< keeps the frame in flight alive
  cl_ulong row_stride_ = 0;
  std::unique_ptr<SlotMemory> memory_;
};

}  // namespace pillarfield
