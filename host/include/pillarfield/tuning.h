#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pillarfield/solver_plan.h"

/// @file
/// Settings for tests and benchmarks, and functions that layers of the library share.
/// Programs do not need them, pillarfield.h does not include them, and they may change with every
/// version.
namespace pillarfield {

/// The kind of stores that write a kernel's results to memory.
enum class Stores : std::uint8_t {
  automatic,  ///< streaming if the results of all slots exceed the device's caches, else cached
  cached,     ///< through the caches
  streaming,  ///< past the caches, if the device's compiler supports it
};

/// Optimisations. They change the speed, never a bit of the result.
struct SpeedPaths {
  /// Skip blocks of idle pillars that were idle too when their slot was last written. The host
  /// always does.
  bool skip_idle = true;
  Stores stores = Stores::automatic;
};

/// Tuning of a Processor for its device.
struct ProcessorTuning {
  /// Pillars that a work-item solves at once: 1, 2, 4, 8 or 16, fewer if a row of the skin is
  /// shorter. 0: DeviceInfo::lanes.
  int lanes = 0;
  SpeedPaths paths = {};
};

/// The complete OpenCL C program of a plan. Its stores are streaming only if `paths.stores` is
/// Stores::streaming.
[[nodiscard]] std::string kernel_source(const SolverPlan& plan, int device_lanes,
                                        const SpeedPaths& paths = {});

/// The names of a plan's stages, in order. They are the same on a device and on the host.
[[nodiscard]] std::vector<std::string> kernel_stages(const SolverPlan& plan);

/// Rate of the tare in the frame that updates its pillar row, 1 − (1 −
/// baseline_rate)^baseline_interval; 0 if the tare is fixed.
[[nodiscard]] double baseline_turn_rate(const SolverPlan& plan);

/// Standard deviation of a raw reading of sensels without a noise plane, counts: the plan's noise
/// and, for integer readings, that of rounding, 1/√12.
[[nodiscard]] double reading_noise(const SolverPlan& plan);

/// Five standard deviations, in counts, of the fourth reading of a pillar as parity predicts it
/// from the other three: a prediction below this margin does not determine whether that sensel is
/// loaded. 0 if the noise is unknown. All pillars share one margin, from the root mean square of
/// the noise of all sensels and gains of 1; in a pillar whose gains are g it amounts to 5 / g
/// deviations.
[[nodiscard]] double region_margin(const SolverPlan& plan);

/// The region margin of sensels that all have this standard deviation, counts.
[[nodiscard]] double region_margin(double noise_counts);

}  // namespace pillarfield
