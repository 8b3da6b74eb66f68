#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

/// The test needs so many small contacts, on so many places, over this share of the lines.
constexpr std::size_t kLeastOrderFrames = 30;
constexpr std::size_t kLeastOrderLines = 4;
constexpr double kLeastSmallShare = 0.6;
constexpr double kLeastVisitedShare = 0.6;
/// Shares of the lines and of the sensels that a small contact loads at most, to 0.3 of its peak.
constexpr double kMostLoadedLines = 0.5;
constexpr double kMostLoadedSensels = 0.15;
constexpr float kLoadedShare = 0.3F;
/// Share of a line in the load of the most loaded one that counts as a visit.
constexpr float kVisit = 0.2F;
/// Excess of a line's similarity to the two lines most like it, over that to its neighbours, from
/// which it is out of place.
constexpr double kOutOfOrder = 0.3;
/// Median similarity of lines to the one most like them, below which a contact is too narrow.
constexpr double kLeastSimilar = 0.3;

/// Sums of the loads of lines, of frames in which a small contact lies on the array.
class LineLoads {
 public:
  LineLoads(const Examination& seen, LineAxis axis) : loads_(seen.lines(axis)) {
    for (const std::uint32_t frame : seen.contacts) add(seen, axis, frame);
    for (std::uint32_t line = 0; line < loads_.size(); ++line) {
      std::size_t visits = 0;
      for (std::size_t n = 0; n < peaks_.size(); ++n) {
        visits += loads_[line][n] > kVisit * peaks_[n] ? 1U : 0U;
      }
      const bool is_second = std::ranges::any_of(seen.shorted, [&](const LinePair& pair) {
        return pair.axis == axis && pair.second == line;
      });
      if (visits >= 3 && !is_second) visited_.push_back(line);
    }
    const auto visited = static_cast<double>(visited_.size());
    shows_order_ = peaks_.size() >= kLeastOrderFrames && visited_.size() >= kLeastOrderLines &&
                   static_cast<double>(peaks_.size()) >
                       kLeastSmallShare * static_cast<double>(seen.contacts.size()) &&
                   visited >= kLeastVisitedShare * static_cast<double>(loads_.size()) &&
                   places_.size() >= std::size_t{seen.rows} + seen.cols;
  }

  /// True if contacts moved so much that the order of lines can be judged.
  [[nodiscard]] bool shows_order() const { return shows_order_; }

  /// The lines whose neighbours are less like them than others are, in pairs that lie apart.
  [[nodiscard]] std::vector<std::uint32_t> out_of_place() const {
    const std::size_t lines = visited_.size();
    std::vector<std::uint32_t> out;
    std::vector<double> closest;
    bool lies_apart = false;
    for (std::size_t a = 0; a < lines; ++a) {
      std::vector<double> similar;
      for (std::size_t b = 0; b < lines; ++b) similar.push_back(a == b ? 0 : similarity(a, b));
      std::vector<std::size_t> others(lines);
      std::iota(others.begin(), others.end(), std::size_t{0});
      std::ranges::sort(others, std::greater<>(), [&](std::size_t b) { return similar[b]; });
      closest.push_back(similar[others[0]]);
      const std::size_t beside = a > 0 && a + 1 < lines ? 2 : 1;
      double excess = 0;
      for (std::size_t n = 0; n < beside; ++n) excess += similar[others[n]];
      if (a > 0) excess -= similar[a - 1];
      if (a + 1 < lines) excess -= similar[a + 1];
      if (excess <= kOutOfOrder) continue;
      for (std::size_t n = 0; n < beside; ++n) {
        const std::uint32_t other = visited_[others[n]];
        lies_apart |= std::ranges::count(out, other) > 0 && other + 1 < visited_[a];
      }
      out.push_back(visited_[a]);
    }
    if (!lies_apart || median(closest) < kLeastSimilar) out.clear();
    return out;
  }

 private:
  void add(const Examination& seen, LineAxis axis, std::uint32_t frame) {
    const auto signals = std::as_const(seen.kept).frame(frame);
    float peak = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (seen.good[i] != 0) peak = std::max(peak, signals[i]);
    }
    std::vector<float> loads(loads_.size());
    double loaded = 0;
    double sum = 0;
    double row = 0;
    double col = 0;
    for (std::size_t i = 0; i < signals.size(); ++i) {
      if (seen.good[i] == 0 || !(signals[i] > kLoadedShare * peak)) continue;
      const SenselPlace at = seen.place(i);
      ++loaded;
      sum += signals[i];
      row += static_cast<double>(signals[i]) * at.first;
      col += static_cast<double>(signals[i]) * at.second;
      loads[axis == LineAxis::rows ? at.first : at.second] += signals[i];
    }
    const float most = std::ranges::max(loads);
    const auto lines =
        std::ranges::count_if(loads, [&](float each) { return each > kLoadedShare * most; });
    if (sum == 0 || loaded > kMostLoadedSensels * static_cast<double>(signals.size()) ||
        static_cast<double>(lines) > kMostLoadedLines * static_cast<double>(loads.size())) {
      return;
    }
    peaks_.push_back(most);
    places_.emplace(std::lround(row / sum), std::lround(col / sum));
    for (std::size_t line = 0; line < loads.size(); ++line) loads_[line].push_back(loads[line]);
  }

  [[nodiscard]] double similarity(std::size_t a, std::size_t b) const {
    const auto product = [&](std::size_t first, std::size_t second) {
      const std::vector<float>& loads = loads_[visited_[first]];
      return std::inner_product(loads.begin(), loads.end(), loads_[visited_[second]].begin(), 0.0);
    };
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
  }

  std::vector<std::vector<float>> loads_;  ///< [line][small contact]
  std::vector<float> peaks_;               ///< of the lines of each
  std::set<std::pair<long, long>> places_;
  std::vector<std::uint32_t> visited_;
  bool shows_order_ = false;
};

}  // namespace

void find_line_orders(Examination& seen, Diagnosis& found) {
  constexpr std::size_t kMostOrderLines = 1024;
  for (const LineAxis axis : {LineAxis::rows, LineAxis::columns}) {
    if (seen.lines(axis) > kMostOrderLines) continue;
    const LineLoads loads(seen, axis);
    if (!loads.shows_order()) continue;
    const bool are_rows = axis == LineAxis::rows;
    (are_rows ? found.row_order_tested : found.column_order_tested) = true;
    ArrayFinding finding = {.fault = are_rows ? ArrayFault::row_order : ArrayFault::column_order,
                            .lines = loads.out_of_place()};
    if (finding.lines.size() < 2) continue;
    finding.figure = static_cast<double>(finding.lines.size());
    add(found, std::move(finding));
  }
}

}  // namespace pillarfield
