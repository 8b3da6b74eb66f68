#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "base/quantile.h"
#include "calibration/doctor/examination.h"
#include "calibration/doctor/finding_text.h"
#include "calibration/doctor/named_orders.h"

namespace pillarfield {
namespace {

/// Similarities of lines, [line, line], in 0..1.
class LineSimilarities {
 public:
  explicit LineSimilarities(std::size_t lines) : lines_(lines), values_(lines * lines) {}

  [[nodiscard]] std::size_t lines() const { return lines_; }
  [[nodiscard]] double operator()(std::size_t a, std::size_t b) const {
    return values_[a * lines_ + b];
  }
  void set(std::size_t a, std::size_t b, double value) {
    values_[a * lines_ + b] = value;
    values_[b * lines_ + a] = value;
  }

 private:
  std::size_t lines_;
  std::vector<double> values_;
};

using LinePath = std::vector<std::uint32_t>;

constexpr double kLeastGain = 1e-9;
constexpr std::size_t kMostStarts = 64;
/// Loss for which neighbours in a path are put back into their order.
constexpr double kOrderLoss = 0.03;

/// Similarity of the lines at two places of a path; 0 beyond its ends.
double link(const LineSimilarities& similar, const LinePath& path, std::size_t a, std::size_t b) {
  return a < path.size() && b < path.size() ? similar(path[a], path[b]) : 0;
}

/// Reverses the part of a path from which the sum gains; returns whether there is one.
bool reverse_part(const LineSimilarities& similar, LinePath& path) {
  for (std::size_t a = 0; a < path.size(); ++a) {
    for (std::size_t b = a + 1; b < path.size(); ++b) {
      const double gain = link(similar, path, a - 1, b) + link(similar, path, a, b + 1) -
                          link(similar, path, a - 1, a) - link(similar, path, b, b + 1);
      if (gain < kLeastGain) continue;
      std::reverse(path.begin() + static_cast<std::ptrdiff_t>(a),
                   path.begin() + static_cast<std::ptrdiff_t>(b) + 1);
      return true;
    }
  }
  return false;
}

/// Moves one line to where the sum gains; returns whether there is such a place.
bool move_line(const LineSimilarities& similar, LinePath& path) {
  for (std::size_t from = 0; from < path.size(); ++from) {
    LinePath rest = path;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(from));
    const double lost = link(similar, path, from - 1, from) + link(similar, path, from, from + 1) -
                        link(similar, rest, from - 1, from);
    for (std::size_t to = 0; to <= rest.size(); ++to) {
      double gain = -lost - link(similar, rest, to - 1, to);
      if (to > 0) gain += similar(rest[to - 1], path[from]);
      if (to < rest.size()) gain += similar(path[from], rest[to]);
      if (gain < kLeastGain) continue;
      rest.insert(rest.begin() + static_cast<std::ptrdiff_t>(to), path[from]);
      path = rest;
      return true;
    }
  }
  return false;
}

void improve(const LineSimilarities& similar, LinePath& path) {
  while (reverse_part(similar, path) || move_line(similar, path)) {
  }
}

/// A path that starts at a line and goes on to the most similar one that is left.
LinePath path_from(const LineSimilarities& similar, std::uint32_t start) {
  LinePath path = {start};
  std::vector<bool> taken(similar.lines());
  taken[start] = true;
  while (path.size() < similar.lines()) {
    std::uint32_t best = 0;
    double most = -1;
    for (std::uint32_t line = 0; line < similar.lines(); ++line) {
      if (taken[line] || similar(path.back(), line) <= most) continue;
      best = line;
      most = similar(path.back(), line);
    }
    taken[best] = true;
    path.push_back(best);
  }
  return path;
}

std::size_t count_in_place(const LinePath& path) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < path.size(); ++i) count += path[i] == i ? 1U : 0U;
  return count;
}

/// Puts pairs of neighbours into rising order where that costs next to nothing.
void put_in_order(const LineSimilarities& similar, LinePath& path) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (path[i] < path[i + 1]) continue;
    const double loss = link(similar, path, i - 1, i) + link(similar, path, i + 1, i + 2) -
                        link(similar, path, i - 1, i + 1) - link(similar, path, i, i + 2);
    if (loss < kOrderLoss) std::swap(path[i], path[i + 1]);
  }
}

/// The sum of the similarities of lines that are neighbours in a path.
double sum_along(const LineSimilarities& similar, const LinePath& path) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += similar(path[i], path[i + 1]);
  return sum;
}

/// The path through all lines with a large sum: the best of those that grow from each of some
/// lines, and of 0, 1, 2 ..., after reversing and moving parts as long as that helps. Of several
/// paths of nearly that sum, one near to 0, 1, 2 ...
LinePath find_path(const LineSimilarities& similar) {
  LinePath best(similar.lines());
  std::iota(best.begin(), best.end(), 0U);
  improve(similar, best);
  const auto step = static_cast<std::uint32_t>(similar.lines() / kMostStarts + 1);
  for (std::uint32_t start = 0; start < similar.lines(); start += step) {
    LinePath path = path_from(similar, start);
    improve(similar, path);
    if (sum_along(similar, path) > sum_along(similar, best) + kLeastGain) best = path;
  }
  LinePath reversed(best.rbegin(), best.rend());
  if (count_in_place(reversed) > count_in_place(best)) best = reversed;
  put_in_order(similar, best);
  return best;
}

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
/// Least gain of the sum of similarities of neighbours by another order, and least median of these
/// similarities.
constexpr double kLeastGainSum = 0.1;
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
  LineSimilarities similar(lines);
  for (std::size_t a = 0; a < lines; ++a) {
    for (std::size_t b = a + 1; b < lines; ++b) {
      similar.set(a, b, product(a, b) / (lengths[a] * lengths[b]));
    }
  }
  return similar;
}

/// Similarity of neighbours in the path `best`, median.
double usual_similarity(const LineSimilarities& similar, const LinePath& best) {
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < best.size(); ++i) values.push_back(similar(best[i], best[i + 1]));
  return median(values);
}

/// Whether the judged lines follow each other in `order` as in the path.
bool agrees(const std::vector<std::uint32_t>& order, const LineLoads& loads, const LinePath& path) {
  std::size_t next = 0;
  for (const std::uint32_t line : order) {
    if (!std::ranges::binary_search(loads.lines, line)) continue;
    if (loads.lines[path[next++]] != line) return false;
  }
  return true;
}

/// Order of all lines.
struct LineOrder {
  std::vector<std::uint32_t> lines;
  bool is_complete = true;  ///< places of lines that were not judged are known too
};

/// A frequent fault of wiring that agrees with the path, or the judged lines in the path's order at
/// their places and the others where they are.
LineOrder order_of(const LineLoads& loads, const LinePath& path, std::size_t lines) {
  LineOrder order;
  order.lines.resize(lines);
  std::iota(order.lines.begin(), order.lines.end(), 0U);
  std::uint32_t first = loads.lines.back();
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path[i] == i) continue;
    first = std::min(first, loads.lines[i]);
    last = loads.lines[i];
    order.lines[loads.lines[i]] = loads.lines[path[i]];
  }
  if (path.size() == lines) return order;
  for (NamedOrder& named : named_orders(static_cast<std::uint32_t>(lines), first, last)) {
    if (!agrees(named.order, loads, path)) continue;
    order.lines = std::move(named.order);
    return order;
  }
  order.is_complete = false;
  return order;
}

/// Marks the places of lines that resemble a neighbour too little to be sure of it, and those of
/// and beside lines whose place is not known. Lines with dead ones between them need not resemble.
void note_doubts(const LineSimilarities& similar, const LineLoads& loads, const LinePath& path,
                 const LineOrder& order, std::vector<std::uint8_t>& doubtful) {
  std::vector<std::uint8_t> lines(order.lines.size());
  std::vector<std::size_t> places(order.lines.size());
  for (std::size_t place = 0; place < places.size(); ++place) places[order.lines[place]] = place;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const std::uint32_t line = loads.lines[path[i]];
    const std::uint32_t next = loads.lines[path[i + 1]];
    if (similar(path[i], path[i + 1]) >= kLeastSimilar || places[next] > places[line] + 1) continue;
    lines[line] = 1;
    lines[next] = 1;
  }
  for (std::size_t place = 0; place < lines.size(); ++place) {
    const std::uint32_t line = order.lines[place];
    if (lines[line] != 0) doubtful[place] = 1;
    if (order.is_complete || std::ranges::binary_search(loads.lines, line)) continue;
    for (const std::size_t near : {place - 1, place, place + 1}) {
      if (near < lines.size()) doubtful[near] = 1;
    }
  }
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
  const LineSimilarities similar = similarities_of(loads);
  LinePath given(loads.lines.size());
  std::iota(given.begin(), given.end(), 0U);
  const LinePath best = find_path(similar);
  const double gain = sum_along(similar, best) - sum_along(similar, given);
  if (gain < kLeastGainSum || usual_similarity(similar, best) < kLeastSimilar) return;
  const LineOrder order = order_of(loads, best, lines);
  (are_rows ? seen.row_order : seen.column_order) = order.lines;
  note_doubts(similar, loads, best, order, are_rows ? seen.doubtful_rows : seen.doubtful_columns);
  ArrayFinding finding = {.fault = are_rows ? ArrayFault::row_order : ArrayFault::column_order,
                          .in_order = order.lines};
  for (std::uint32_t i = 0; i < lines; ++i) {
    if (order.lines[i] != i) finding.lines.push_back(i);
  }
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
