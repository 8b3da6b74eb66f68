#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// A square skin of so many pillars a side, and the bare direct solve of its uint8 frames: forces
/// and status bytes.
SolverPlan bare_plan(std::uint32_t pillars_a_side, SenselType type = SenselType::u8);

/// The skin of most rows: a square metre.
inline constexpr std::uint32_t kSquareMetre = 790;

/// The names that add_stage takes: "none", "tare", ..., "all".
std::vector<std::string_view> stage_names();

/// Adds a stage to a plan by its name, with calibration planes that differ from sensel to sensel.
/// "all" is what a calibrated sensor needs: tare, gain, mask, dead zone, saturation, uncertainty
/// and angles. Throws Error on a name that is none.
void add_stage(SolverPlan& plan, std::string_view name);

/// What the solve of a plan reads and writes when it can skip no pillar. Planes of a sensel have
/// four values a pillar.
struct Streams {
  SenselType sensel_type = SenselType::u8;
  int calibration_planes = 0;  ///< float32, read
  bool mask = false;           ///< uint8, read
  bool tare_follows = false;   ///< one of the calibration planes is written too
  int result_planes = 3;       ///< float32, written; and the status byte

  [[nodiscard]] std::size_t bytes_per_pillar() const;
};
Streams streams_of(const SolverPlan& plan);

}  // namespace pillarfield::bench
