#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"

namespace pillarfield {

// The judge of sensels of the tare, the search for faults and the live watch.

/// Evidence of one sensel from raw readings, counts.
struct SenselEvidence {
  SenselStatistics read = {};
  double level = 0;  ///< reading without load
  double noise = 0;  ///< standard deviation of that

  [[nodiscard]] bool is_constant() const { return read.lowest == read.highest; }
};

/// The evidence of frames without load.
[[nodiscard]] std::vector<SenselEvidence> evidence_without_load(const FrameStatistics& unloaded);

/// Medians of the sensels that may be sound.
struct TypicalSensel {
  std::size_t count = 0;
  double level = 0;
  double low = 0;     ///< 2nd percentile of the levels of those that vary
  double spread = 0;  ///< robust standard deviation of the levels, at least the noise
  double noise = 0;
};

/// The least standard deviation of a reading: that of rounding to whole counts.
[[nodiscard]] double least_noise(SenselType type);

/// The value that stands for "no sensel": at least two constant sensels read it, or one if it is
/// -1, and the sensels that vary stay clear of it. Unset: there is none.
[[nodiscard]] std::optional<float> absent_value(std::span<const SenselEvidence> sensels);

/// Verdicts by the readings of single sensels.
class SenselJudge {
 public:
  /// Sensels that `mask` excludes, where it is not empty, are not typical.
  SenselJudge(std::vector<SenselEvidence> sensels, std::uint32_t frames,
              std::span<const std::uint8_t> mask);

  /// not_a_number, absent, saturated, stuck or noisy; unset: nothing is wrong with its readings.
  [[nodiscard]] std::optional<SenselFault> verdict(std::size_t sensel) const;

  /// True if a reading without load is far above the typical one.
  [[nodiscard]] bool is_far_above(std::size_t sensel) const;

  [[nodiscard]] const TypicalSensel& typical() const { return typical_; }
  [[nodiscard]] std::span<const SenselEvidence> sensels() const { return sensels_; }

 private:
  [[nodiscard]] std::optional<SenselFault> verdict_of_constant(std::size_t sensel) const;

  std::vector<SenselEvidence> sensels_;
  std::uint32_t frames_;
  TypicalSensel typical_;
  double vary_share_ = 0;  ///< share of the present sensels that vary
  double lowest_ = std::numeric_limits<double>::infinity();    ///< of the sensels that vary
  double highest_ = -std::numeric_limits<double>::infinity();  ///< of these
  std::optional<float> absent_;
};

/// True if most of the frames have no reading.
[[nodiscard]] bool lacks_readings(const SenselStatistics& read, std::uint32_t frames);

/// True if most of the readings are at full scale.
[[nodiscard]] bool is_saturated(const SenselStatistics& read);

/// True if the range of readings is that of noise alone: at most ten times `noise`.
[[nodiscard]] bool is_still(const SenselStatistics& read, double noise);

}  // namespace pillarfield
