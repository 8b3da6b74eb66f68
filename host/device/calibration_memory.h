#pragma once

#include <vector>

#include "device/large_pages.h"
#include "device/opencl.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

enum class CalibrationPlane : std::uint8_t {
  tare,
  gain,
  dead_zone,
  noise,
  mask,
  activation,
  bend_x,
  bend_y,
  bend_xy,
  memory,  ///< the states of sensels; the last, and larger than a plane
};

/// The macro that holds the plane's index.
[[nodiscard]] const char* macro_of(CalibrationPlane plane);

/// Planes that the kernel of a plan reads, in memory order.
[[nodiscard]] std::vector<CalibrationPlane> calibration_planes(const SolverPlan& plan,
                                                               bool has_activation);

/// The calibration planes of a plan, contiguous in the memory of the device.
class CalibrationMemory {
 public:
  /// A null context keeps the planes in the host's memory, with activation thresholds as float.
  CalibrationMemory(const cl::Context& context, const SolverPlan& plan,
                    std::vector<CalibrationPlane> planes);

  [[nodiscard]] const std::vector<CalibrationPlane>& planes() const { return planes_; }
  /// Null if the plan has no calibration plane, and without a context.
  [[nodiscard]] const cl::Buffer& buffer() const { return buffer_; }
  /// The planes in the host's memory; null if a device keeps them in its own.
  [[nodiscard]] std::byte* bytes() const { return memory_.get(); }
  /// Distance between planes.
  [[nodiscard]] std::size_t plane_bytes() const { return plane_bytes_; }
  /// Sensels of a row of the planes: even without pillars too, where the last may not exist.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// Sets all states of sensels to rest; no kernel may be running.
  void clear_states() const;
  /// The tares as they are, [sensel rows, cols]; there must be some.
  [[nodiscard]] std::vector<float> tare() const;
  /// True if there is a tare; it is the first plane.
  [[nodiscard]] bool has_tare() const { return has_tare_; }

 private:
  [[nodiscard]] cl::CommandQueue queue() const;
  void copy_plane(const SolverPlan& plan, CalibrationPlane plane, std::byte* to) const;

  std::vector<CalibrationPlane> planes_;
  std::size_t rows_;
  std::size_t cols_;
  std::size_t stride_;
  std::size_t plane_bytes_;
  std::size_t state_bytes_ = 0;  ///< behind the planes
  bool has_tare_;
  bool is_on_host_;
  LargePages memory_;  ///< used if the device shares the host's memory
  cl::Buffer buffer_;
};

}  // namespace pillarfield
