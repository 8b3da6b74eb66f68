#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// What computes, and how exactly.
enum class Arithmetic : std::uint8_t {
  device_float,  ///< the kernels
  host_double,  ///< a C++ loop over kernels/pillar, on all threads; its results are stored as float
};

/// One way to solve the frames of a sensor with noise.
struct SolveVariant {
  Estimator estimator = Estimator::direct;
  Arithmetic arithmetic = Arithmetic::device_float;
  SenselType type = SenselType::u8;
  /// "none", "calibration" (tare, gain, dead zone, mask), "angles", "uncertainty", or "all", as
  /// add_stage has it.
  std::string_view stage = "none";
};

/// "direct/float/u8/none".
[[nodiscard]] std::string name_of(const SolveVariant& variant);

/// All that there are. Neighbours share their frames where they can.
[[nodiscard]] std::vector<SolveVariant> solve_variants();

/// The sensor's noise before its converter rounds, and what it takes for silence: of uint8 and
/// float32 sensels.
inline constexpr double kSensorNoiseCounts = 0.5;
inline constexpr double kSensorThresholdCounts = 2.5;

/// Counts of a type for one of uint8: uint16 sensels count 16 times finer.
[[nodiscard]] double count_scale(SenselType type);

/// The plan of a variant for a square skin.
[[nodiscard]] SolverPlan plan_of(const SolveVariant& variant, std::uint32_t pillars_a_side);

}  // namespace pillarfield::bench
