#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "device/device_calibration.h"
#include "device/device_state.h"
#include "device/slot.h"
#include "pillarfield/tuning.h"

namespace pillarfield {

/// Settings that all slots of a processor share.
struct SlotSettings {
  cl::Program program;
  int lanes = 1;
  bool shares_memory = false;
  SpeedPaths paths;
};

/// One frame in flight on an OpenCL device: a queue of its own, a kernel with its arguments, and
/// memory.
class OpenClSlot final : public Slot {
 public:
  OpenClSlot(Device::State& device, const SolverPlan& plan, const SlotSettings& settings,
             const DeviceCalibration& calibration, FrameOrder& order);
  ~OpenClSlot() override;

  /// The next frames are solved by another plan of the same frames and outputs.
  void set_plan(const SolverPlan& plan, const SlotSettings& settings,
                const DeviceCalibration& calibration);

  void submit(const FrameView& frame, const std::optional<Curvature>& bent,
              const single_precision::Drift& drift) override;
  void wait() override;
  bool is_done() override;
  [[nodiscard]] const ResultMemory& memory() const override { return *memory_; }

 private:
  void make_kernels(const SolverPlan& plan, const SlotSettings& settings,
                    const DeviceCalibration& calibration);
  FrameView padded(const FrameView& frame);
  /// Starts a kernel on the frame.
  void launch(cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
              const std::vector<cl::Event>* after = nullptr, cl::Event* done = nullptr);
  /// Solves the frame; after the frame before, where there is an order.
  void solve(const std::optional<Curvature>& bent, const single_precision::Drift& drift);

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
  cl::Event done_;      ///< behind the frame, once is_done() was asked for it; else null
  std::optional<FrameBuffer> padded_;  ///< of a frame that lacks sensels of its last quads
  cl::Buffer frame_;                   ///< keeps the frame in flight alive
  single_precision::Layout layout_{};
  std::unique_ptr<SlotMemory> memory_;
};

}  // namespace pillarfield
