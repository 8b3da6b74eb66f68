#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/number_text.h"
#include "calibration/doctor/examination.h"

namespace pillarfield {
namespace {

constexpr std::size_t kListedPlaces = 8;

std::string places_of(const ArrayFinding& finding) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kListedPlaces, finding.sensels.size()); ++i) {
    const auto [row, col] = finding.sensels[i];
    text += fmt::format("{}({}, {})", i == 0 ? "" : ", ", row, col);
  }
  return finding.sensels.size() > kListedPlaces ? text + ", ..." : text;
}

std::string sentence_of(const ArrayFinding& finding) {
  const std::vector<std::uint32_t>& lines = finding.lines;
  const double figure = finding.figure;
  const std::string count = counted(finding.sensels.size(), "sensel");
  const char* const line = is_of_rows(finding.fault) ? "row" : "column";
  switch (finding.fault) {
    case ArrayFault::absent:
      return fmt::format(
          "Absent: {}, {}, at {}", count,
          figure == 0 ? "without a reading or always 0"
                      : fmt::format("always {}, which stands for no sensel", rounded(figure)),
          places_of(finding));
    case ArrayFault::dead:
      return fmt::format("Dead: {}, at most {:.1f} % of the response of the neighbours, at {}",
                         count, figure, places_of(finding));
    case ArrayFault::stuck:
      return fmt::format("Stuck: {}, constant (median {} counts) while the others vary, at {}",
                         count, rounded(figure), places_of(finding));
    case ArrayFault::saturated:
      return fmt::format("Saturated: {}, at full scale ({} counts) most of the time, at {}", count,
                         rounded(figure), places_of(finding));
    case ArrayFault::noisy:
      return fmt::format("Noisy: {}, {:.0f} times the noise of the others, at {}", count, figure,
                         places_of(finding));
    case ArrayFault::dead_row:
    case ArrayFault::dead_column:
      return fmt::format("Dead: {} {}, at most {:.1f} % of the response of its neighbours", line,
                         lines[0], figure);
    case ArrayFault::shorted_rows:
    case ArrayFault::shorted_columns:
      return fmt::format("Shorted: {}s {} and {} differ by {:.1f} % of their signals", line,
                         lines[0], lines[1], figure);
    case ArrayFault::row_order:
    case ArrayFault::column_order:
      return fmt::format("Wiring: {}s out of order: a contact passes {} out of turn", line,
                         fmt::join(lines, ", "));
    case ArrayFault::weak:
      return fmt::format("Weak: {}, at most {:.1f} % of the response of the neighbours, at {}",
                         count, figure, places_of(finding));
    case ArrayFault::rest_after_release:
    case ArrayFault::followed_baseline: {
      const bool is_up = finding.fault == ArrayFault::rest_after_release;
      return fmt::format(
          "Rest: after {} of {} releases {} {} counts {}, at {}: {}", finding.seen,
          finding.releases, finding.sensels.size() == 1 ? "1 sensel stays" : count + " stay",
          rounded(figure), is_up ? "up" : "below the rest before", places_of(finding),
          is_up ? "rest or a load that you do not see"
                : "the board itself follows the baseline; switch that off");
    }
    case ArrayFault::ghosts:
      return fmt::format(
          "Ghosts: {}, reading up to {} counts only while the other three corners "
          "of a rectangle are pressed, at {}; the wiring lacks diodes or a virtual "
          "ground, and no calibration step mends it",
          count, rounded(figure), places_of(finding));
    default:
      return finding.text;
  }
}

}  // namespace

const char* name_of(ArrayFault fault) {
  constexpr std::array kNames = {"absent",
                                 "dead",
                                 "weak",
                                 "stuck",
                                 "saturated",
                                 "noisy",
                                 "dead row",
                                 "dead column",
                                 "shorted rows",
                                 "shorted columns",
                                 "row order",
                                 "column order",
                                 "ghosts",
                                 "rest after release",
                                 "followed baseline",
                                 "missing frames",
                                 "repeated frames",
                                 "frozen",
                                 "normalised",
                                 "two values",
                                 "byte order"};
  return kNames.at(static_cast<std::size_t>(fault));
}

const char* name_of(Polarity polarity) {
  if (polarity == Polarity::unknown) return "unknown";
  return polarity == Polarity::rises ? "rises" : "falls";
}

bool is_of_rows(ArrayFault fault) {
  return fault == ArrayFault::dead_row || fault == ArrayFault::shorted_rows ||
         fault == ArrayFault::row_order;
}

void add(Diagnosis& found, ArrayFinding finding) {
  finding.text = sentence_of(finding);
  found.findings.push_back(std::move(finding));
}

}  // namespace pillarfield
