#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "pillarfield/solver_plan.h"

namespace pillarfield::bench {

/// The bare direct solve of a square skin's frames: forces and status bytes.
SolverPlan bare_plan(std::uint32_t pillars_a_side, SenselType type = SenselType::u8);

/// Pillars a side of a square metre, the skin of most cases.
inline constexpr std::uint32_t kSquareMetre = 790;

/// The names that add_stage takes: "none", "tare", ..., "all".
std::vector<std::string_view> stage_names();

/// Adds a stage to a plan by its name, with calibration planes that differ from sensel to sensel.
/// "all" is the stages of a calibrated sensor: tare, gain, mask, dead zone, saturation, uncertainty
/// and angles. Throws Error on an unknown name.
void add_stage(SolverPlan& plan, std::string_view name);

/// Memory traffic of a plan's solve without idle blocks. A plane of sensels has four values a
/// pillar.
struct Streams {
  SenselType sensel_type = SenselType::u8;
  int calibration_planes = 0;  ///< float32, read
  bool mask = false;           ///< uint8, read
  bool tare_follows = false;   ///< the tare plane is written too
  int result_planes = 3;       ///< float32, written with the status byte

  [[nodiscard]] std::size_t bytes_per_pillar() const;
};
Streams streams_of(const SolverPlan& plan);

}  // namespace pillarfield::bench
