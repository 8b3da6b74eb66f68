#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "device/device_state.h"
#include "device/opencl.h"
#include "device/slot.h"
#include "lanes/calibration_memory.h"
#include "pillarfield/tuning.h"

namespace pillarfield {

/// The calibration planes of a plan in the memory of a device.
// cl::Buffer moves without an exception, and does not say so.
// NOLINTNEXTLINE(bugprone-exception-escape)
class DeviceCalibration {
 public:
  /// A null context keeps the planes in the host's memory.
  DeviceCalibration(const cl::Context& context, CalibrationMemory planes);

  /// The planes in the host's memory, which a device with its own has not.
  [[nodiscard]] const CalibrationMemory& planes() const { return planes_; }
  /// Null if the plan has no calibration plane, and without a context.
  [[nodiscard]] const cl::Buffer& buffer() const { return buffer_; }
  /// Sets all states of sensels to rest; no kernel may be running.
  void clear_states() const;
  /// The tares as they are, [rows, cols] sensels; there must be some.
  [[nodiscard]] std::vector<float> tare(std::size_t rows, std::size_t cols) const;

 private:
  [[nodiscard]] cl::CommandQueue queue() const;

  CalibrationMemory planes_;  ///< outlives the buffer, which may use it
  cl::Buffer buffer_;
};

/// Settings that all slots of a processor share.
struct SlotSettings {
  cl::Program program;
  int lanes = 1;
  SpeedPaths paths;
  Transfers* transfers = nullptr;  ///< of a device with its own memory; null if it is shared
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
  cl::Buffer numbers_;  ///< of the plan
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
