#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pillarfield/sensor_effects.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Values of Calibration::mask. A pillar without any sensel has status 0; one that has some counts
/// the absent ones as missing while it is in contact, and reads no contact otherwise.
inline constexpr std::uint8_t kMissing = 0;  ///< dead or masked: a fault
inline constexpr std::uint8_t kGood = 1;
inline constexpr std::uint8_t kAbsent = 2;  ///< the sensor has no sensel there: no fault

/// Curvature of a skin, 1/mm: its height over the tangent plane is −(x X² + y Y² + xy X Y)/2.
struct Curvature {
  double x = 0;
  double y = 0;
  double xy = 0;
};

/// Corrections of single sensels: planes [sensel rows, cols], row by row. An empty plane needs no
/// correction, and none is compiled into the kernel.
///
/// A sensel with sensitivity g, tare t and dead zone z reads raw = t + g·max(0, V − z) for the V of
/// equation (2). It is usable if (raw − t)·gain, gain = 1/g, is above the threshold; then
/// V = (raw − t)·gain + z.
struct Calibration {
  std::vector<float> tare;         ///< reading of the unloaded sensel, counts, |tare| <= full scale
  std::vector<float> gain;         ///< factor on (raw − tare), [kMinGain, kMaxGain]
  std::vector<float> dead_zone;    ///< load below which a sensel reads zero, counts, >= 0
  std::vector<std::uint8_t> mask;  ///< kMissing, kGood or kAbsent
  std::vector<float> noise;        ///< standard deviation of the unloaded raw reading, counts, >= 0
  /// Change of the tare with the curvature of the skin, counts·mm: all three or none. The tare of a
  /// skin bent to curvatures (x, y, xy), 1/mm, is tare + bend_x·x + bend_y·y + bend_xy·xy (E8).
  std::vector<float> bend_x;
  std::vector<float> bend_y;
  std::vector<float> bend_xy;
  SensorEffects effects;  ///< corrections that all sensels share

  [[nodiscard]] bool empty() const {
    return tare.empty() && gain.empty() && dead_zone.empty() && mask.empty() && noise.empty() &&
           bend_x.empty() && effects.empty();
  }
};

/// True if the sensel of this index exists and is not masked.
[[nodiscard]] inline bool is_good(const Calibration& calibration, std::size_t sensel) {
  return calibration.mask.empty() || calibration.mask[sensel] == kGood;
}

/// True if no sensel of an element (a pillar or a single sensel) exists.
[[nodiscard]] bool lacks_sensels(const Calibration& calibration, const Skin& skin,
                                 std::uint32_t row, std::uint32_t col);

/// The number of elements none of whose sensels exists.
[[nodiscard]] std::size_t count_absent_elements(const Calibration& calibration, const Skin& skin);

/// The number of sensels that the sensor does not have.
[[nodiscard]] std::size_t count_absent(const Calibration& calibration);

/// The number of sensels masked as missing.
[[nodiscard]] std::size_t count_masked(const Calibration& calibration);

/// Limits of Calibration::gain.
inline constexpr double kMinGain = 1e-2;
inline constexpr double kMaxGain = 1e2;

/// Largest standard deviation of a reading, counts.
inline constexpr double kMaxNoiseCounts = 1e6;

/// Largest tare, dead zone and noise for float readings and for an unknown type: 30 bits.
inline constexpr double kMaxPlaneCounts = 1e9;

/// The largest reading of a type: 255, 65535, or kMaxPlaneCounts for floats.
[[nodiscard]] double largest_plane_counts(SenselType type);

/// Throws Error, naming `where`, if a plane is neither empty nor of the skin's size, or a value is
/// out of range: tare within ± largest_plane_counts(type), dead zone and noise from 0 to that
/// (noise at most kMaxNoiseCounts), gain within [kMinGain, kMaxGain], mask 0, 1 or 2.
void check(const Calibration& calibration, const Skin& skin, std::string_view where,
           std::optional<SenselType> type = {});

}  // namespace pillarfield
