#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "calibration/doctor/kept_frames.h"
#include "calibration/sensel_judge.h"
#include "pillarfield/doctor.h"
#include "pillarfield/frame_statistics.h"

namespace pillarfield {

/// Multiple of the noise beyond which a reading is not noise.
inline constexpr double kBeyondIdleNoise = 6;

/// Rows or columns.
enum class LineAxis : std::uint8_t { rows, columns };

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
  std::uint32_t frames_with_readings = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  double full_scale = 0;                    ///< counts; infinite: unknown
  std::vector<float> idle = {};             ///< reading without load, of each sensel, counts
  std::vector<float> noise = {};            ///< standard deviation of that, counts
  std::vector<std::uint8_t> noisy = {};     ///< 1: it varies far more than others
  double typical_noise = 0;                 ///< median, at least that of rounding, counts
  std::vector<float> lowest = {};           ///< of the readings of each sensel but for one, counts
  std::vector<float> highest = {};          ///< counts
  double span = 0;                          ///< largest range of a sensel's readings, counts
  std::vector<std::uint8_t> constant = {};  ///< 1: the reading never changes, or there is none
  std::vector<std::uint8_t> good = {};      ///< 1: no fault found so far
  std::vector<std::optional<SenselFault>> verdicts = {};  ///< of each sensel
  std::vector<std::uint32_t> contacts = {};  ///< kept frames in which something touches the array
  double contact_counts = 0;                 ///< median of their largest signals
  std::vector<std::uint32_t> touched = {};   ///< number of contacts in which a sensel is loaded
  bool was_swept = false;                    ///< small contacts moved over most rows or columns
  bool is_out_of_order = false;              ///< neighbours need not lie beside each other
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
  [[nodiscard]] double threshold(std::size_t sensel) const;
  /// True if a sensel varies, and is not noisy.
  [[nodiscard]] bool is_steady(std::size_t sensel) const;
};

/// True if a contact is on few sensels.
[[nodiscard]] bool is_small_contact(const Examination& seen, std::uint32_t frame);

/// True if small contacts moved over most lines.
[[nodiscard]] bool is_swept(const Examination& seen, LineAxis axis);

/// Difference of each line and the next one, relative to their signals, but for gains of single
/// sensels; unset: too little signal.
[[nodiscard]] std::vector<std::optional<double>> neighbour_differences(const Examination& seen,
                                                                       LineAxis axis);

/// Direction of readings under load: loads are local and large, drift and offsets common and slow.
[[nodiscard]] Polarity find_polarity(const Examination& seen);

/// True if the layout is pillars, or might be.
[[nodiscard]] bool may_have_pillars(const Diagnosis& found);

// Each step writes what it finds into the examination and into the diagnosis, in this order.

/// Frames and values that are no readings.
void find_odd_frames(const Examination& seen, const FrameWatch& watch, Diagnosis& found);
/// Noise, drift, polarity, idle readings; replaces the kept readings by signals; finds contacts.
void find_signals(Examination& seen, Diagnosis& found);
/// Verdicts by readings alone; sensels that have one are not good for the next steps.
void find_odd_readings(Examination& seen, const Diagnosis& found);
/// The layout: pillars if groups of 2 x 2 sensels share their loads.
void find_layout(const Examination& seen, Diagnosis& found);
/// Two lines with the same signals, of different pillars.
void find_shorts(Examination& seen, Diagnosis& found);
/// The order in which a small contact passes lines.
void find_line_orders(Examination& seen, Diagnosis& found);
/// Signals in the rows and columns of small contacts, far from them.
void find_crosstalk(Examination& seen, Diagnosis& found);
/// Sensels that read only while the other three corners of a rectangle are pressed.
void find_ghosts(Examination& seen, Diagnosis& found);
/// Sensels that are constant or do not respond, and rows and columns of them.
void find_faulty_sensels(Examination& seen, Diagnosis& found);
}  // namespace pillarfield
