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

/// What makes the order that `order` is of 0, 1, 2 ..., where that has a name.
std::string name_of_order(const std::vector<std::uint32_t>& order,
                          const std::vector<std::uint32_t>& moved, std::string_view lines) {
  if (moved.size() == 2) return fmt::format("{} {} and {} are swapped", lines, moved[0], moved[1]);
  const std::uint32_t first = moved.front();
  const std::uint32_t last = moved.back();
  bool is_mirrored = true;
  for (std::uint32_t i = first; i <= last; ++i) is_mirrored &= order[i] == first + last - i;
  if (is_mirrored) return fmt::format("{} {} to {} are mirrored", lines, first, last);
  const auto half = static_cast<std::uint32_t>((order.size() + 1) / 2);
  bool are_halves_read_by_turns = true;  // 0, 2, 4 ... lie first
  bool lie_by_turns = true;              // 0, half, 1, half + 1 ...
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    are_halves_read_by_turns &= order[i] == (i < half ? 2 * i : 2 * (i - half) + 1);
    lie_by_turns &= order[i] == (i % 2 == 0 ? i / 2 : half + i / 2);
  }
  if (are_halves_read_by_turns || lie_by_turns) {
    return fmt::format("the halves of the {} are interleaved", lines);
  }
  bool is_shifted = true;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    is_shifted &= order[i] == (i + order[0]) % order.size();
  }
  if (is_shifted) return fmt::format("the {} begin with {}", lines, order[0]);
  return fmt::format("{} of the {} lie elsewhere", moved.size(), lines);
}

std::string order_text(const ArrayFinding& finding, std::string_view lines) {
  std::string text = name_of_order(finding.in_order, finding.lines, lines);
  text.front() = static_cast<char>(std::toupper(text.front()));
  return text + fmt::format(": a contact passes {} of {} lines out of turn", finding.lines.size(),
                            finding.in_order.size());
}

std::string count_text(const ArrayFinding& finding) {
  return counted(finding.sensels.size(), "sensel");
}

std::string sentence_of(const ArrayFinding& finding) {
  const std::vector<std::uint32_t>& lines = finding.lines;
  switch (finding.fault) {
    case ArrayFault::absent:
      return fmt::format("Absent: {}, without a reading or always 0, at {}", count_text(finding),
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
      return "Wiring: " + order_text(finding, "rows");
    case ArrayFault::column_order:
      return "Wiring: " + order_text(finding, "columns");
    case ArrayFault::row_crosstalk:
      return fmt::format("Crosstalk: {:.1f} % of a contact shows all along its rows",
                         finding.figure);
    case ArrayFault::column_crosstalk:
      break;
  }
  return fmt::format("Crosstalk: {:.1f} % of a contact shows all along its columns",
                     finding.figure);
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
      break;
  }
  return "column crosstalk";
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
