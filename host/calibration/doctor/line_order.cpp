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

/// A contact on few sensels.
struct SmallContact {
  SenselPlace centre;        ///< of pressure, in whole sensels
  std::vector<float> loads;  ///< sums of the loaded sensels of each line
};

/// Sums of the signals of each line, of frames in which a small contact lies on the array.
struct LineLoads {
  std::vector<std::uint32_t> lines;       ///< those that were visited
  std::vector<std::vector<float>> loads;  ///< of these, [line][frame]
  std::size_t frames = 0;
  std::size_t places = 0;  ///< different centres of pressure
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

/// Unset: the contact is on many sensels or lines. Ghosts of crosstalk are not loaded.
std::optional<SmallContact> small_contact_in(const Examination& seen, LineAxis axis,
                                             std::uint32_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  float most = peak_of(seen, frame);
  SmallContact contact;
  contact.loads.resize(seen.lines(axis));
  double loaded = 0;
  double sum = 0;
  double row = 0;
  double col = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (seen.good[i] == 0 || !(signals[i] > kLoaded * most)) continue;
    const SenselPlace at = seen.place(i);
    ++loaded;
    sum += signals[i];
    row += static_cast<double>(signals[i]) * at.first;
    col += static_cast<double>(signals[i]) * at.second;
    contact.loads[axis == LineAxis::rows ? at.first : at.second] += signals[i];
  }
  if (sum == 0 || loaded > kMostLoadedSensels * static_cast<double>(signals.size())) return {};
  most = std::ranges::max(contact.loads);
  const auto lines =
      std::ranges::count_if(contact.loads, [&](float l) { return l > kLoaded * most; });
  if (static_cast<double>(lines) > kMostLoadedLines * static_cast<double>(seen.lines(axis)))
    return {};
  contact.centre = {std::lround(row / sum), std::lround(col / sum)};
  return contact;
}

LineLoads find_loads(const Examination& seen, LineAxis axis) {
  std::vector<SmallContact> contacts;
  for (const std::uint32_t frame : seen.contacts) {
    if (auto contact = small_contact_in(seen, axis, frame)) contacts.push_back(std::move(*contact));
  }
  LineLoads result;
  std::set<SenselPlace> places;
  std::vector<std::size_t> visits(seen.lines(axis));
  for (const SmallContact& contact : contacts) {
    places.insert(contact.centre);
    const float most = std::ranges::max(contact.loads);
    for (std::size_t line = 0; line < visits.size(); ++line) {
      visits[line] += contact.loads[line] > kVisit * most ? 1U : 0U;
    }
  }
  result.frames = contacts.size();
  result.places = places.size();
  for (std::uint32_t line = 0; line < visits.size(); ++line) {
    if (visits[line] < 3) continue;
    result.lines.push_back(line);
    auto& loads = result.loads.emplace_back();
    for (const SmallContact& contact : contacts) loads.push_back(contact.loads[line]);
  }
  return result;
}

/// True if contacts moved so much that the order of lines can be judged.
bool shows_order(const Examination& seen, const LineLoads& loads, LineAxis axis) {
  return loads.frames >= kLeastOrderFrames &&
         static_cast<double>(loads.frames) >
             kLeastSmallShare * static_cast<double>(seen.contacts.size()) &&
         loads.lines.size() >= kLeastLines &&
         static_cast<double>(loads.lines.size()) >=
             kLeastVisitedShare * static_cast<double>(seen.lines(axis)) &&
         loads.places >= std::size_t{seen.rows} + seen.cols;
}

/// Leaves out one of two neighbours that are shorted.
void drop_shorted(const Examination& seen, LineAxis axis, LineLoads& loads) {
  for (const LinePair& pair : seen.shorted) {
    const auto at = std::ranges::find(loads.lines, pair.second);
    if (pair.axis != axis || at == loads.lines.end()) continue;
    loads.loads.erase(loads.loads.begin() + (at - loads.lines.begin()));
    loads.lines.erase(at);
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

bool is_small_contact(const Examination& seen, std::uint32_t frame) {
  const auto signals = std::as_const(seen.kept).frame(frame);
  const float most = peak_of(seen, frame);
  std::size_t loaded = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    loaded += seen.good[i] != 0 && signals[i] > kLoaded * most ? 1U : 0U;
  }
  return loaded > 0 &&
         static_cast<double>(loaded) <= kMostLoadedSensels * static_cast<double>(signals.size());
}

bool is_swept(const Examination& seen, LineAxis axis) {
  return shows_order(seen, find_loads(seen, axis), axis);
}

void find_line_orders(Examination& seen, Diagnosis& found) {
  find_order(seen, LineAxis::rows, found);
  find_order(seen, LineAxis::columns, found);
}

}  // namespace pillarfield
