#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"

namespace pillarfield {
namespace {

/// Similarities of lines, [line][line], in 0..1; 0 with themselves.
using LineSimilarities = std::vector<std::vector<double>>;

constexpr std::size_t kLeastOrderFrames = 30;
constexpr std::size_t kLeastLines = 4;
constexpr std::size_t kMostLines = 1024;
/// Shares of the lines and of the sensels that a small contact loads at most at a time: to 0.3 of
/// its largest load.
constexpr double kMostLoadedLines = 0.5;
constexpr double kMostLoadedSensels = 0.15;
constexpr float kLoaded = 0.3F;
/// Share of a line in the load of the most loaded one that counts as a visit.
constexpr float kVisit = 0.2F;
/// Share of the contacts that must be small.
constexpr double kLeastSmallShare = 0.6;
/// Share of the lines that contacts must visit.
constexpr double kLeastVisitedShare = 0.6;
/// Excess of a line's similarity to the two lines most like it, over that to its neighbours, from
/// which it is out of place.
constexpr double kOutOfPlace = 0.3;
/// Median similarity of lines to the one most like them, below which a contact is too narrow.
constexpr double kLeastSimilar = 0.3;

/// Sums of the signals of each line, of frames in which a small contact lies on the array.
struct LineLoads {
  std::vector<std::uint32_t> lines;       ///< those that were visited
  std::vector<std::vector<float>> loads;  ///< of these, [line][frame]
  std::size_t frames = 0;
  std::size_t places = 0;  ///< different places of their centres of pressure, in whole sensels
};

/// The largest signal of a frame.
float peak_of(const Examination& seen, std::uint32_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  float most = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] != 0) most = std::max(most, signals[i]);
  }
  return most;
}

/// Sums of the loaded sensels, which ghosts of crosstalk are not.
std::vector<float> loads_of_frame(const Examination& seen, LineAxis axis, std::uint32_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  const float most = peak_of(seen, frame);
  const std::size_t lines = seen.lines(axis);
  const std::size_t length = signals.size() / lines;
  std::vector<float> loads(lines);
  for (std::size_t line = 0; line < lines; ++line) {
    for (std::size_t along = 0; along < length; ++along) {
      const std::size_t i = seen.sensel(axis, line, along);
      const bool is_loaded = seen.good[i] != 0 && signals[i] > kLoaded * most;
      loads[line] += is_loaded ? signals[i] : 0;
    }
  }
  return loads;
}

LineLoads find_loads(const Examination& seen, LineAxis axis) {
  const std::size_t lines = seen.lines(axis);
  std::vector<std::vector<float>> all(lines);
  std::vector<std::size_t> visits(lines);
  std::set<SenselPlace> places;
  for (const std::uint32_t frame : seen.contacts) {
    const auto centre = centre_of_small_contact(seen, frame);
    if (!centre) continue;
    const std::vector<float> loads = loads_of_frame(seen, axis, frame);
    const float most = *std::ranges::max_element(loads);
    const auto loaded = std::ranges::count_if(loads, [&](float l) { return l > kLoaded * most; });
    if (most == 0 || static_cast<double>(loaded) > kMostLoadedLines * static_cast<double>(lines)) {
      continue;
    }
    places.insert(*centre);
    for (std::size_t line = 0; line < lines; ++line) {
      all[line].push_back(loads[line]);
      visits[line] += loads[line] > kVisit * most ? 1U : 0U;
    }
  }
  LineLoads result;
  result.frames = all.front().size();
  result.places = places.size();
  for (std::uint32_t line = 0; line < lines; ++line) {
    if (visits[line] < 3) continue;
    result.lines.push_back(line);
    result.loads.push_back(std::move(all[line]));
  }
  return result;
}

/// Whether contacts moved so much that the order of lines can be judged.
bool shows_order(const Examination& seen, const LineLoads& loads, LineAxis axis) {
  return loads.frames >= kLeastOrderFrames &&
         static_cast<double>(loads.frames) >
             kLeastSmallShare * static_cast<double>(seen.contacts.size()) &&
         loads.lines.size() >= kLeastLines &&
         static_cast<double>(loads.lines.size()) >=
             kLeastVisitedShare * static_cast<double>(seen.lines(axis)) &&
         loads.places >= std::size_t{seen.rows} + seen.cols;
}

/// Leaves out shorted lines, which show contacts in two places, but for one of two neighbours.
void drop_shorted(const Examination& seen, LineAxis axis, LineLoads& loads) {
  const auto drop = [&](std::uint32_t line) {
    const auto at = std::ranges::find(loads.lines, line);
    if (at == loads.lines.end()) return;
    loads.loads.erase(loads.loads.begin() + (at - loads.lines.begin()));
    loads.lines.erase(at);
  };
  for (const LinePair& pair : seen.shorted) {
    if (pair.axis != axis) continue;
    if (pair.second - pair.first > 1) drop(pair.first);
    drop(pair.second);
  }
}

LineSimilarities similarities_of(const LineLoads& loads) {
  const std::size_t lines = loads.lines.size();
  const auto product = [&](std::size_t a, std::size_t b) {
    return std::inner_product(loads.loads[a].begin(), loads.loads[a].end(), loads.loads[b].begin(),
                              0.0);
  };
  std::vector<double> lengths(lines);
  for (std::size_t a = 0; a < lines; ++a) lengths[a] = std::sqrt(product(a, a));
  LineSimilarities similar(lines, std::vector<double>(lines));
  for (std::size_t a = 0; a < lines; ++a) {
    for (std::size_t b = a + 1; b < lines; ++b) {
      similar[a][b] = similar[b][a] = product(a, b) / (lengths[a] * lengths[b]);
    }
  }
  return similar;
}

/// The lines whose neighbours are less like them than others are, in pairs that lie apart.
std::vector<std::uint32_t> lines_out_of_place(const LineLoads& loads) {
  const LineSimilarities similar = similarities_of(loads);
  const std::size_t lines = loads.lines.size();
  std::vector<std::uint32_t> out;
  std::vector<double> closest;
  bool lies_apart = false;
  for (std::size_t a = 0; a < lines; ++a) {
    std::vector<std::size_t> others(lines);
    std::iota(others.begin(), others.end(), std::size_t{0});
    std::ranges::sort(others, std::greater<>(), [&](std::size_t b) { return similar[a][b]; });
    closest.push_back(similar[a][others[0]]);
    const std::size_t beside = a > 0 && a + 1 < lines ? 2 : 1;
    double excess = 0;
    for (std::size_t n = 0; n < beside; ++n) excess += similar[a][others[n]];
    if (a > 0) excess -= similar[a][a - 1];
    if (a + 1 < lines) excess -= similar[a][a + 1];
    if (excess <= kOutOfPlace) continue;
    for (std::size_t n = 0; n < beside; ++n) {
      const std::uint32_t other = loads.lines[others[n]];
      lies_apart |= std::ranges::count(out, other) > 0 && other + 1 < loads.lines[a];
    }
    out.push_back(loads.lines[a]);
  }
  if (!lies_apart || median(closest) < kLeastSimilar) out.clear();
  return out;
}

void find_order(Examination& seen, LineAxis axis, Diagnosis& found) {
  const std::size_t lines = seen.lines(axis);
  const bool are_rows = axis == LineAxis::rows;
  if (lines < kLeastLines || lines > kMostLines) return;
  LineLoads loads = find_loads(seen, axis);
  if (!shows_order(seen, loads, axis)) return;
  drop_shorted(seen, axis, loads);
  if (loads.lines.size() < kLeastLines) return;
  (are_rows ? found.row_order_tested : found.column_order_tested) = true;
  ArrayFinding finding = {.fault = are_rows ? ArrayFault::row_order : ArrayFault::column_order,
                          .lines = lines_out_of_place(loads)};
  if (finding.lines.size() < 2) return;
  seen.is_out_of_order = true;
  finding.figure = static_cast<double>(finding.lines.size());
  add(found, std::move(finding));
}

}  // namespace

std::optional<SenselPlace> centre_of_small_contact(const Examination& seen, std::uint32_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  const float most = peak_of(seen, frame);
  std::size_t loaded = 0;
  double sum = 0;
  double row = 0;
  double col = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] == 0 || !(signals[i] > kLoaded * most)) continue;
    ++loaded;
    sum += signals[i];
    const std::size_t at_row = i / seen.cols;
    const std::size_t at_col = i % seen.cols;
    row += signals[i] * static_cast<double>(at_row);
    col += signals[i] * static_cast<double>(at_col);
  }
  if (sum == 0 ||
      static_cast<double>(loaded) > kMostLoadedSensels * static_cast<double>(signals.size())) {
    return std::nullopt;
  }
  return SenselPlace{std::lround(row / sum), std::lround(col / sum)};
}

bool is_swept(const Examination& seen, LineAxis axis) {
  return shows_order(seen, find_loads(seen, axis), axis);
}

void find_line_orders(Examination& seen, Diagnosis& found) {
  find_order(seen, LineAxis::rows, found);
  find_order(seen, LineAxis::columns, found);
}

}  // namespace pillarfield
