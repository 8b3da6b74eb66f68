#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/large_pages.h"
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
  release,  ///< memories of touches after even turns of a followed baseline
  release_after_odd,
  memory,  ///< the states of sensels; the last, and larger than a plane
};

/// Planes that the kernel of a plan reads, in memory order.
[[nodiscard]] std::vector<CalibrationPlane> calibration_planes(const SolverPlan& plan,
                                                               bool has_activation);

/// The calibration planes of a plan, contiguous in the host's memory.
class CalibrationMemory {
 public:
  /// Activation thresholds are stored as readings of this type.
  CalibrationMemory(const SolverPlan& plan, std::vector<CalibrationPlane> planes,
                    SenselType thresholds);

  [[nodiscard]] const std::vector<CalibrationPlane>& planes() const { return planes_; }
  /// Null if the plan has no calibration plane.
  [[nodiscard]] std::byte* bytes() const { return memory_.get(); }
  /// Bytes of all planes, and of the states of sensels, which are the last of them.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t state_bytes() const { return state_bytes_; }
  /// Distance between planes.
  [[nodiscard]] std::size_t plane_bytes() const { return plane_bytes_; }
  /// Sensels of a row of the planes: even without pillars too, where the last may not exist.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  /// The tares as they are, [rows, cols]; there must be some.
  [[nodiscard]] std::vector<float> tare(std::size_t rows, std::size_t cols) const;
  /// True if there is a tare; it is the first plane.
  [[nodiscard]] bool has_tare() const;
  /// Gives up the memory, which a device has copied.
  void free() { memory_.reset(); }

 private:
  std::vector<CalibrationPlane> planes_;
  std::size_t stride_;
  std::size_t plane_bytes_;
  std::size_t state_bytes_;  ///< behind the planes
  std::size_t size_ = 0;
  LargePages memory_;
};

}  // namespace pillarfield
