#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// Precision, and the code that computes.
enum class Arithmetic : std::uint8_t {
  device_float,  ///< the kernels
  host_double,   ///< a C++ loop over kernels/pillar, on all threads; stores float results
};

/// A variant of the solve of a noisy sensor's frames.
struct SolveVariant {
  Estimator estimator = Estimator::direct;
  Arithmetic arithmetic = Arithmetic::device_float;
  SenselType type = SenselType::u8;
  /// "none", "calibration" (tare, gain, dead zone, mask), or one of "angles", "uncertainty", "all"
  /// of add_stage.
  std::string_view stage = "none";
};

/// "direct/float/u8/none".
[[nodiscard]] std::string name_of(const SolveVariant& variant);

/// All variants, in an order in which neighbours share frames.
[[nodiscard]] std::vector<SolveVariant> solve_variants();

/// Noise before the converter rounds, and threshold, of uint8 and float32 sensels.
inline constexpr double kSensorNoiseCounts = 0.5;
inline constexpr double kSensorThresholdCounts = 2.5;

/// Counts of a type per count of uint8: 16 for uint16, else 1.
[[nodiscard]] double count_scale(SenselType type);

/// The plan of a variant for a square skin.
[[nodiscard]] SolverPlan plan_of(const SolveVariant& variant, std::uint32_t pillars_a_side);

}  // namespace pillarfield::bench
