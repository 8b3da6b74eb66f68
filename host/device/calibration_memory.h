#pragma once

#include <vector>

#include "device/large_pages.h"
#include "device/opencl.h"
#include "pillarfield/tuning.h"

namespace pillarfield {

/// A plane that calibrates sensels, as kernels read it.
enum class CalibrationPlane : std::uint8_t { tare, gain, dead_zone, noise, mask, wake };

/// The macro of its place among the planes of a plan.
[[nodiscard]] const char* macro_of(CalibrationPlane plane);

/// Those that the kernel of a plan reads, in the order in which they lie in memory.
[[nodiscard]] std::vector<CalibrationPlane> calibration_planes(const SolverPlan& plan,
                                                               const SpeedPaths& paths);

/// The calibration planes of a plan in one block of the device's, one after the other.
class CalibrationMemory {
 public:
  CalibrationMemory(const cl::Context& context, const SolverPlan& plan, const SpeedPaths& paths);

  /// Null where the plan has none.
  [[nodiscard]] const cl::Buffer& buffer() const { return buffer_; }
  /// From one plane to the next.
  [[nodiscard]] std::size_t plane_bytes() const { return plane_bytes_; }
  /// Whether there is a tare; it is the first plane.
  [[nodiscard]] bool has_tare() const { return has_tare_; }

 private:
  std::size_t plane_bytes_;
  bool has_tare_;
  LargePages memory_;  ///< where the device uses the host's
  cl::Buffer buffer_;
};

}  // namespace pillarfield
