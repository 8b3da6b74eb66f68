#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pillarfield/skin.h"

namespace pillarfield {

/// What is known of each sensel apart: planes [rows, cols] of sensels, row by row. An empty plane
/// means that nothing has to be corrected, and its correction is not compiled into the kernel.
///
/// A sensel of sensitivity g, tare t and dead zone z answers the model's V of equation (2) with
/// raw = t + g·max(0, V − z). Its reading is therefore taken as V = (raw − t)·gain + z where
/// (raw − t)·gain is above the threshold, with gain = 1/g.
struct Calibration {
  std::vector<float> tare;         ///< counts, reading of the unloaded sensel, |tare| <= full scale
  std::vector<float> gain;         ///< factor on (raw − tare) that makes sensels equal, > 0
  std::vector<float> dead_zone;    ///< counts, what a sensel swallows before it answers, >= 0
  std::vector<std::uint8_t> mask;  ///< 1 = good, 0 = missing (dead, absent or masked)
  std::vector<float> noise;  ///< counts of the raw reading, standard deviation, unloaded, >= 0

  [[nodiscard]] bool empty() const {
    return tare.empty() && gain.empty() && dead_zone.empty() && mask.empty() && noise.empty();
  }
};

/// The number of sensels that the mask has as missing.
[[nodiscard]] std::size_t count_masked(const Calibration& calibration);

/// Limits of Calibration::gain.
inline constexpr double kMinGain = 1e-2;
inline constexpr double kMaxGain = 1e2;

/// Limit of Calibration::noise, and of noise elsewhere.
inline constexpr double kMaxNoiseCounts = 1e6;

/// Limit of tare, dead zone and noise where readings are floats or of a type that is not known. A
/// reading of 1e9 counts would be one of 30 bits.
inline constexpr double kMaxPlaneCounts = 1e9;

/// The largest reading of integer sensels, 255 or 65535; kMaxPlaneCounts of floats.
[[nodiscard]] double largest_plane_counts(SenselType type);

/// Throws Error, its place being `where`, when a plane has not one value per sensel of `skin` or a
/// value is out of its range: tare within ± the largest reading of `type`, dead zone from 0 to it,
/// noise from 0 to it and to kMaxNoiseCounts, gain from kMinGain to kMaxGain, mask 0 or 1.
void check(const Calibration& calibration, const Skin& skin, std::string_view where,
           std::optional<SenselType> type = {});

}  // namespace pillarfield
