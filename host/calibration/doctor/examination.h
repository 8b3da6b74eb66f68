#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/doctor/kept_frames.h"
#include "calibration/doctor/response_watch.h"
#include "pillarfield/doctor.h"
#include "pillarfield/frame_statistics.h"

namespace pillarfield {

/// Multiple of the noise beyond which a reading is not noise.
inline constexpr double kBeyondIdleNoise = 6;

/// Two lines of one axis.
struct LinePair {
  LineAxis axis;
  std::uint32_t first;
  std::uint32_t second;
};

/// Evidence of the findings: kept frames as signals, and what is known of each sensel.
struct Examination {
  const FrameStatistics& statistics;        ///< of all frames
  std::vector<SenselStatistics> read = {};  ///< of the frames that are not missing
  KeptFrames& kept;  ///< after find_signals(): counts beyond idle, under load > 0
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double full_scale = 0;                    ///< counts; infinite: unknown
  std::vector<float> idle = {};             ///< reading without load, of each sensel, counts
  std::vector<float> noise = {};            ///< standard deviation of that, counts
  std::vector<float> jitter = {};           ///< the same from frame to frame
  double typical_noise = 0;                 ///< median, at least that of rounding, counts
  std::vector<float> lowest = {};           ///< of the readings of each sensel but for one, counts
  std::vector<float> highest = {};          ///< counts
  double span = 0;                          ///< largest range of a sensel that changes fast, counts
  std::vector<std::uint8_t> sudden = {};    ///< 1: it changes faster than drift
  bool has_load = false;                    ///< something came or went
  std::size_t loaded_frames = 0;            ///< kept frames with any load
  std::vector<std::uint8_t> constant = {};  ///< 1: the reading never changes, or there is none
  std::vector<std::uint8_t> noisy = {};     ///< 1: it varies far more than the others do
  std::vector<std::uint8_t> good = {};      ///< 1: no fault found so far
  std::vector<std::optional<SenselFault>> verdicts = {};  ///< of each sensel
  std::vector<std::uint32_t> contacts = {};  ///< kept frames in which something touches the array
  double contact_counts = 0;                 ///< median of their largest signals
  double usual_peak = 0;                     ///< their 90th percentile
  std::vector<std::uint32_t> touched = {};   ///< number of contacts in which a sensel is loaded
  std::vector<LinePair> shorted = {};

  [[nodiscard]] std::size_t lines(LineAxis axis) const {
    return axis == LineAxis::rows ? rows : cols;
  }
  [[nodiscard]] std::size_t sensel(LineAxis axis, std::size_t line, std::size_t along) const {
    return axis == LineAxis::rows ? line * cols + along : along * cols + line;
  }
  [[nodiscard]] SenselPlace place(std::size_t sensel) const {
    return {static_cast<std::uint32_t>(sensel / cols), static_cast<std::uint32_t>(sensel % cols)};
  }
  /// Noise of a sensel, at least the typical one, counts.
  [[nodiscard]] double noise_of(std::size_t sensel) const {
    return std::max<double>(noise[sensel], typical_noise);
  }
  /// Least signal of a loaded sensel, counts.
  [[nodiscard]] double threshold(std::size_t sensel) const {
    return kBeyondIdleNoise * noise_of(sensel);
  }
  /// True if a sensel varies, and is not noisy.
  [[nodiscard]] bool is_steady(std::size_t sensel) const {
    return constant[sensel] == 0 && noisy[sensel] == 0;
  }
};

/// True of faults of rows.
[[nodiscard]] bool is_of_rows(ArrayFault fault);
/// Adds a finding with its sentence.
void add(Diagnosis& found, ArrayFinding finding);

/// Direction of readings under load: loads are local and large, drift and offsets common and slow.
[[nodiscard]] Polarity find_polarity(const Examination& seen);

// Each step writes what it finds into the examination and into the diagnosis, in this order. Each
// finding is a hypothesis with an exposure that its test needs; without it nothing is said.

/// Frames and values that are no readings.
void find_odd_frames(const Examination& seen, const FrameWatch& watch, Diagnosis& found);
/// Noise, drift, polarity, idle readings; replaces the kept readings by signals; finds contacts.
void find_signals(Examination& seen, Diagnosis& found);
/// Absent, stuck, saturated and noisy sensels, by the readings of each; they are not good after it.
void find_odd_sensels(Examination& seen, Diagnosis& found);
/// Dead and weak sensels and dead lines, by their neighbours, and what nothing tested.
void find_responses(Examination& seen, Diagnosis& found);
/// Two lines with the same signals.
void find_shorts(Examination& seen, Diagnosis& found);
/// The order in which a small contact passes lines.
void find_line_orders(Examination& seen, Diagnosis& found);
/// Sensels that read only while the other three corners of a rectangle are pressed.
void find_ghosts(Examination& seen, Diagnosis& found);
/// Sensels whose rest is another one after a touch.
void find_rests(const Examination& seen, Diagnosis& found);

}  // namespace pillarfield
