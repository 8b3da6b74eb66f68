#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"

namespace pillarfield {
namespace {

/// Per cent of a contact's largest signal in its line from which its ghosts are crosstalk.
constexpr double kLeastGhostPercent = 1;
/// The same in deviations of the mean over the frames, taken as a tenth independent.
constexpr double kLeastSignificance = 4;
constexpr std::size_t kLeastGhostFrames = 20;
/// A sensel is loaded from this share of a frame's largest signal; ghosts are below.
constexpr double kContactShare = 0.25;
constexpr double kLeastPeak = 0.3;  ///< of a contact, in the usual one
constexpr double kPeakNoise = 20;   ///< the same in the noise

/// A mean over sensels.
struct SignalMean {
  double sum = 0;
  double count = 0;

  void add(double signal) {
    sum += signal;
    ++count;
  }
  [[nodiscard]] double mean() const { return sum / count; }
};

/// The rows or columns of a frame: the part that is loaded, and the signals far from it.
struct ContactLines {
  explicit ContactLines(std::size_t lines) : first(lines), peaks(lines), ghosts(lines) {}

  std::size_t first;
  std::size_t last = 0;
  std::vector<double> peaks;       ///< largest signals of lines
  std::vector<SignalMean> ghosts;  ///< of lines, far from the contact

  void include(std::size_t line) {
    first = std::min(first, line);
    last = std::max(last, line);
  }
  /// True if a line is farther from the contact than the contact is wide.
  [[nodiscard]] bool is_far(std::size_t line) const {
    const std::size_t margin = std::max<std::size_t>(last - first + 1, 3);
    return line + margin < first || line > last + margin;
  }
  /// Ghosts relative to the peaks of their lines; unset: none is far enough.
  [[nodiscard]] std::optional<double> ratio(double common) const {
    double products = 0;
    double squares = 0;
    for (std::size_t line = first; line <= last; ++line) {
      if (ghosts[line].count < 2) continue;
      products += peaks[line] * (ghosts[line].mean() - common);
      squares += peaks[line] * peaks[line];
    }
    return squares > 0 ? std::optional(products / squares) : std::nullopt;
  }
};

using GhostRatios = std::array<std::vector<double>, 2>;  ///< along rows, along columns

/// Adds the ghosts of a frame.
void add_ghosts(const Examination& seen, std::uint32_t frame, GhostRatios& ratios) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  ContactLines rows(seen.rows);
  ContactLines cols(seen.cols);
  double peak = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] != 0) peak = std::max<double>(peak, signals[i]);
  }
  if (peak < std::max(kLeastPeak * seen.contact_counts, kPeakNoise * seen.typical_noise)) return;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] == 0) continue;
    const auto [row, col] = seen.place(i);
    rows.peaks[row] = std::max<double>(rows.peaks[row], signals[i]);
    cols.peaks[col] = std::max<double>(cols.peaks[col], signals[i]);
    if (signals[i] < kContactShare * peak) continue;
    rows.include(row);
    cols.include(col);
  }
  SignalMean common;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] == 0) continue;
    const auto [row, col] = seen.place(i);
    if (rows.is_far(row) && cols.is_far(col)) common.add(signals[i]);
    if (cols.is_far(col)) rows.ghosts[row].add(signals[i]);
    if (rows.is_far(row)) cols.ghosts[col].add(signals[i]);
  }
  if (common.count < 8) return;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (const auto ratio = (axis == 0 ? rows : cols).ratio(common.mean())) {
      ratios.at(axis).push_back(*ratio);
    }
  }
}

void judge_crosstalk(std::vector<double>& ratios, ArrayFault fault, std::optional<double>& percent,
                     Diagnosis& found) {
  if (ratios.size() < kLeastGhostFrames) return;
  const double middle = median(ratios);
  percent = 100 * middle;
  std::vector<double> distances;
  distances.reserve(ratios.size());
  for (const double ratio : ratios) distances.push_back(std::abs(ratio - middle));
  const double deviation = 1.4826 * median(distances) /
                           std::sqrt(std::max(1.0, static_cast<double>(ratios.size()) / 10));
  if (*percent < kLeastGhostPercent || middle < kLeastSignificance * deviation) return;
  ArrayFinding finding = {.fault = fault};
  finding.figure = *percent;
  add(found, std::move(finding));
}

}  // namespace

void find_crosstalk(Examination& seen, Diagnosis& found) {
  if (seen.is_out_of_order || !seen.was_swept) return;
  GhostRatios ratios;
  for (const std::uint32_t frame : seen.contacts) add_ghosts(seen, frame, ratios);
  judge_crosstalk(ratios[0], ArrayFault::row_crosstalk, found.row_crosstalk_percent, found);
  judge_crosstalk(ratios[1], ArrayFault::column_crosstalk, found.column_crosstalk_percent, found);
}

}  // namespace pillarfield
