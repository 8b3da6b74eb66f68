#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "calibration/doctor/examination.h"
#include "calibration/neighbours.h"

namespace pillarfield {
namespace {

/// Signals of pressed corners and of a ghost, in the usual largest signal, and the most that a
/// ghost reads of the weakest corner.
constexpr double kPressedShare = 0.3;
constexpr double kGhostShare = 0.1;
constexpr double kMostOfCorners = 0.9;
constexpr std::size_t kMostPeaks = 12;
constexpr std::size_t kLeastGhostSightings = 5;  ///< with the ghost
constexpr std::size_t kLeastWithout = 3;         ///< with two of its corners, without the ghost

using RectangleCells = std::array<std::uint32_t, 4>;  ///< row and column of a ghost, and opposite

/// Looks for sensels that read in step with the other corners of a rectangle.
class GhostSearch {
 public:
  explicit GhostSearch(const Examination& seen) : seen_(seen) {
    for (const std::uint32_t frame : seen.contacts) add_rectangles(frame);
  }

  /// The ghosts, and the largest reading of each.
  [[nodiscard]] std::map<SenselPlace, double> ghosts() const {
    std::map<SenselPlace, double> ghosts;
    for (const auto& [rectangle, frames] : rectangles_) {
      if (frames < kLeastGhostSightings) continue;
      const double most = reading_of_ghost(rectangle);
      double& largest = ghosts[{rectangle[0], rectangle[1]}];
      largest = std::max(largest, most);
    }
    std::erase_if(ghosts, [](const auto& ghost) { return ghost.second == 0; });
    return ghosts;
  }

 private:
  [[nodiscard]] float signal(std::uint32_t frame, std::size_t sensel) const {
    return seen_.good[sensel] != 0 ? std::as_const(seen_.kept).frame(frame)[sensel] : 0;
  }
  [[nodiscard]] float signal(std::uint32_t frame, std::uint32_t row, std::uint32_t col) const {
    return signal(frame, seen_.sensel(LineAxis::rows, row, col));
  }

  /// True if a sensel is loaded more than all around it.
  [[nodiscard]] bool is_peak(std::uint32_t frame, std::size_t sensel) const {
    const Neighbours around(seen_.statistics.skin(), sensel);
    return std::ranges::none_of(
        around.all(), [&](std::size_t i) { return signal(frame, i) >= signal(frame, sensel); });
  }

  void add_rectangles(std::uint32_t frame) {
    std::vector<SenselPlace> peaks;
    for (std::size_t i = 0; i < seen_.kept.sensels() && peaks.size() <= kMostPeaks; ++i) {
      const bool reads = signal(frame, i) > kGhostShare * seen_.contact_counts;
      if (reads && is_peak(frame, i)) peaks.push_back(seen_.place(i));
    }
    if (peaks.size() > kMostPeaks) return;
    for (const auto& [row, col] : peaks) {
      for (const auto& [other_row, other_col] : peaks) {
        const bool has_corners = row != other_row && col != other_col &&
                                 std::ranges::count(peaks, SenselPlace(row, other_col)) > 0 &&
                                 std::ranges::count(peaks, SenselPlace(other_row, col)) > 0;
        const RectangleCells rectangle = {row, col, other_row, other_col};
        if (has_corners && pressed(frame, rectangle) == 3 && shows(frame, rectangle)) {
          ++rectangles_[rectangle];
        }
      }
    }
  }

  [[nodiscard]] std::array<float, 3> corners(std::uint32_t frame, const RectangleCells& at) const {
    return {signal(frame, at[0], at[3]), signal(frame, at[2], at[1]), signal(frame, at[2], at[3])};
  }
  /// Number of pressed corners.
  [[nodiscard]] std::ptrdiff_t pressed(std::uint32_t frame, const RectangleCells& at) const {
    return std::ranges::count_if(corners(frame, at), [&](float each) {
      return each > kPressedShare * seen_.contact_counts;
    });
  }
  /// True if the fourth sensel reads, and less than the corners.
  [[nodiscard]] bool shows(std::uint32_t frame, const RectangleCells& at) const {
    const float ghost = signal(frame, at[0], at[1]);
    return ghost > kGhostShare * seen_.contact_counts && are_apart(frame, at) &&
           ghost < kMostOfCorners * std::ranges::min(corners(frame, at));
  }

  /// True if nothing joins the corners, which one contact would.
  [[nodiscard]] bool are_apart(std::uint32_t frame, const RectangleCells& at) const {
    const float most = signal(frame, at[0], at[1]) / 2;
    const std::uint32_t row = (at[0] + at[2]) / 2;
    const std::uint32_t col = (at[1] + at[3]) / 2;
    return signal(frame, row, at[1]) < most && signal(frame, row, at[3]) < most &&
           signal(frame, at[0], col) < most && signal(frame, at[2], col) < most;
  }

  /// The largest reading of a sensel that reads always with three corners and never with two; 0 if
  /// it does not.
  [[nodiscard]] double reading_of_ghost(const RectangleCells& at) const {
    std::size_t with = 0;
    std::size_t missing = 0;
    std::size_t without = 0;
    float most = 0;
    for (const std::uint32_t frame : seen_.contacts) {
      const std::ptrdiff_t corners = pressed(frame, at);
      if (corners == 3) {
        ++(shows(frame, at) ? with : missing);
        most = std::max(most, signal(frame, at[0], at[1]));
      } else if (corners == 2) {
        if (signal(frame, at[0], at[1]) > kGhostShare * seen_.contact_counts) return 0;
        ++without;
      }
    }
    return 20 * missing <= with && without >= kLeastWithout ? most : 0;
  }

  const Examination& seen_;
  std::map<RectangleCells, std::size_t> rectangles_;  ///< frames in which they show a ghost
};

}  // namespace

void find_ghosts(Examination& seen, Diagnosis& found) {
  ArrayFinding finding = {.fault = ArrayFault::ghosts};
  for (const auto& [place, reading] : GhostSearch(seen).ghosts()) {
    finding.sensels.push_back(place);
    finding.figure = std::max(finding.figure, reading);
  }
  if (!finding.sensels.empty()) add(found, std::move(finding));
}

}  // namespace pillarfield
