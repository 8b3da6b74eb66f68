#include "calibration/doctor/finding_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "base/number_text.h"

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

std::string order_text(const ArrayFinding& finding, std::string_view lines) {
  std::string list;
  for (const std::uint32_t line : finding.lines) {
    list += fmt::format("{}{}", list.empty() ? "" : ", ", line);
  }
  return fmt::format("Wiring: {} out of order: a contact passes {} out of turn", lines, list);
}

std::string count_text(const ArrayFinding& finding) {
  return counted(finding.sensels.size(), "sensel");
}

std::string sentence_of(const ArrayFinding& finding) {
  const std::vector<std::uint32_t>& lines = finding.lines;
  switch (finding.fault) {
    case ArrayFault::absent:
      return fmt::format("Absent: {}, {}, at {}", count_text(finding),
                         finding.figure == 0 ? "without a reading or always 0"
                                             : fmt::format("always {}, which stands for no sensel",
                                                           rounded(finding.figure)),
                         places_of(finding));
    case ArrayFault::dead:
      return fmt::format("Dead: {}, at most {:.1f} % of the response of the neighbours, at {}",
                         count_text(finding), finding.figure, places_of(finding));
    case ArrayFault::stuck:
      return fmt::format("Stuck: {}, constant (median {} counts) while the others vary, at {}",
                         count_text(finding), rounded(finding.figure), places_of(finding));
    case ArrayFault::saturated:
      return fmt::format("Saturated: {}, at full scale ({} counts) most of the time, at {}",
                         count_text(finding), rounded(finding.figure), places_of(finding));
    case ArrayFault::noisy:
      return fmt::format("Noisy: {}, {:.0f} times the noise of the others, at {}",
                         count_text(finding), finding.figure, places_of(finding));
    case ArrayFault::dead_row:
      return fmt::format("Dead: row {}, at most {:.1f} % of the response of its neighbours",
                         lines[0], finding.figure);
    case ArrayFault::dead_column:
      return fmt::format("Dead: column {}, at most {:.1f} % of the response of its neighbours",
                         lines[0], finding.figure);
    case ArrayFault::shorted_rows:
      return fmt::format("Shorted: rows {} and {} differ by {:.1f} % of their signals", lines[0],
                         lines[1], finding.figure);
    case ArrayFault::shorted_columns:
      return fmt::format("Shorted: columns {} and {} differ by {:.1f} % of their signals", lines[0],
                         lines[1], finding.figure);
    case ArrayFault::row_order:
      return order_text(finding, "rows");
    case ArrayFault::column_order:
      return order_text(finding, "columns");
    case ArrayFault::row_crosstalk:
      return fmt::format("Crosstalk: {:.1f} % of a contact shows all along its rows",
                         finding.figure);
    case ArrayFault::column_crosstalk:
      return fmt::format("Crosstalk: {:.1f} % of a contact shows all along its columns",
                         finding.figure);
    case ArrayFault::ghosts:
      return fmt::format(
          "Ghosts: {}, reading up to {} counts only while the other three corners "
          "of a rectangle are pressed, at {}; the wiring lacks diodes or a virtual "
          "ground, and no calibration step mends it",
          count_text(finding), rounded(finding.figure), places_of(finding));
    default:
      return finding.text;
  }
}

}  // namespace

const char* name_of(ArrayFault fault) {
  switch (fault) {
    case ArrayFault::absent:
      return "absent";
    case ArrayFault::dead:
      return "dead";
    case ArrayFault::stuck:
      return "stuck";
    case ArrayFault::saturated:
      return "saturated";
    case ArrayFault::noisy:
      return "noisy";
    case ArrayFault::dead_row:
      return "dead row";
    case ArrayFault::dead_column:
      return "dead column";
    case ArrayFault::shorted_rows:
      return "shorted rows";
    case ArrayFault::shorted_columns:
      return "shorted columns";
    case ArrayFault::row_order:
      return "row order";
    case ArrayFault::column_order:
      return "column order";
    case ArrayFault::row_crosstalk:
      return "row crosstalk";
    case ArrayFault::column_crosstalk:
      return "column crosstalk";
    case ArrayFault::ghosts:
      return "ghosts";
    case ArrayFault::missing_frames:
      return "missing frames";
    case ArrayFault::repeated_frames:
      return "repeated frames";
    case ArrayFault::frozen:
      return "frozen";
    case ArrayFault::normalised:
      return "normalised";
    case ArrayFault::two_values:
      return "two values";
    case ArrayFault::byte_order:
      return "byte order";
    case ArrayFault::stuck_bit:
      break;
  }
  return "stuck bit";
}

const char* name_of(Polarity polarity) {
  if (polarity == Polarity::unknown) return "unknown";
  return polarity == Polarity::rises ? "rises" : "falls";
}

const char* name_of(ArrayLayout layout) {
  if (layout == ArrayLayout::unknown) return "unknown";
  return layout == ArrayLayout::pillars ? "pillars" : "sensels";
}

void add(Diagnosis& found, ArrayFinding finding) {
  finding.text = sentence_of(finding);
  found.findings.push_back(std::move(finding));
}

}  // namespace pillarfield
