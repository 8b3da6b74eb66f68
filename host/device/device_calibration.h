#pragma once

#include <vector>

#include "device/opencl.h"
#include "lanes/calibration_memory.h"

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

}  // namespace pillarfield
