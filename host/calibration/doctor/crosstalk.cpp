#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

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

/// Loaded lines from `first` to `last`, in the order in which they lie.
struct ContactExtent {
  std::size_t first = 0;
  std::size_t last = 0;
  void include(std::size_t line, bool is_first) {
    first = is_first ? line : std::min(first, line);
    last = is_first ? line : std::max(last, line);
  }
  /// Whether a line is farther from the contact than the contact is wide.
  [[nodiscard]] bool is_far(std::size_t line) const {
    const std::size_t margin = std::max<std::size_t>(last - first + 1, 3);
    return line + margin < first || line > last + margin;
  }
};

class CrosstalkMeter {
 public:
  explicit CrosstalkMeter(const Examination& seen) : seen_(seen) {}

  void add(std::uint32_t frame) {
    signals_ = std::as_const(seen_.kept).frame(frame);
    if (!find_contact()) return;
    const std::optional<double> common = common_signal();
    if (!common) return;
    add_ghosts(LineAxis::rows, *common);
    add_ghosts(LineAxis::columns, *common);
  }

  [[nodiscard]] std::vector<double>& ratios(LineAxis axis) {
    return axis == LineAxis::rows ? of_rows_ : of_columns_;
  }

 private:
  bool find_contact() {
    float peak = 0;
    for (std::size_t i = 0; i < signals_.size(); ++i) {
      if (seen_.good[i] != 0) peak = std::max(peak, signals_[i]);
    }
    if (peak < 0.3 * seen_.contact_counts || peak < 20 * seen_.typical_noise) return false;
    bool is_first = true;
    for (std::size_t row = 0; row < seen_.rows; ++row) {
      for (std::size_t col = 0; col < seen_.cols; ++col) {
        const std::size_t i = seen_.sensel(LineAxis::rows, row, col);
        if (seen_.good[i] == 0 || signals_[i] < kContactShare * peak) continue;
        rows_.include(row, is_first);
        cols_.include(col, is_first);
        is_first = false;
      }
    }
    return true;
  }

  /// Mean of the sensels far from the contact's rows and columns.
  [[nodiscard]] std::optional<double> common_signal() {
    values_.clear();
    for (std::size_t row = 0; row < seen_.rows; ++row) {
      if (!rows_.is_far(row)) continue;
      for (std::size_t col = 0; col < seen_.cols; ++col) {
        if (cols_.is_far(col) && seen_.good[seen_.sensel(LineAxis::rows, row, col)] != 0) {
          values_.push_back(signals_[seen_.sensel(LineAxis::rows, row, col)]);
        }
      }
    }
    if (values_.size() < 8) return std::nullopt;
    return std::accumulate(values_.begin(), values_.end(), 0.0) /
           static_cast<double>(values_.size());
  }

  void add_ghosts(LineAxis axis, double common) {
    const bool in_rows = axis == LineAxis::rows;
    const ContactExtent& lines = in_rows ? rows_ : cols_;
    const ContactExtent& along = in_rows ? cols_ : rows_;
    double products = 0;
    double squares = 0;
    for (std::size_t line = lines.first; line <= lines.last; ++line) {
      values_.clear();
      double peak = 0;
      for (std::size_t place = 0; place < (in_rows ? seen_.cols : seen_.rows); ++place) {
        const std::size_t i = in_rows ? seen_.sensel(LineAxis::rows, line, place)
                                      : seen_.sensel(LineAxis::rows, place, line);
        if (seen_.good[i] == 0) continue;
        peak = std::max<double>(peak, signals_[i]);
        if (along.is_far(place)) values_.push_back(signals_[i] - static_cast<float>(common));
      }
      if (values_.size() < 2) continue;
      const double sum = std::accumulate(values_.begin(), values_.end(), 0.0);
      products += peak * sum / static_cast<double>(values_.size());
      squares += peak * peak;
    }
    if (squares > 0) ratios(axis).push_back(products / squares);
  }

  const Examination& seen_;
  std::span<const float> signals_;
  ContactExtent rows_;
  ContactExtent cols_;
  std::vector<float> values_;
  std::vector<double> of_rows_;
  std::vector<double> of_columns_;
};

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
  if (seen.is_out_of_order) return;
  CrosstalkMeter meter(seen);
  for (const std::uint32_t frame : seen.contacts) meter.add(frame);
  judge_crosstalk(meter.ratios(LineAxis::rows), ArrayFault::row_crosstalk,
                  found.row_crosstalk_percent, found);
  judge_crosstalk(meter.ratios(LineAxis::columns), ArrayFault::column_crosstalk,
                  found.column_crosstalk_percent, found);
}

}  // namespace pillarfield
