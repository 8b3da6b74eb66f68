#include "calibration/doctor/line_path.h"

#include <algorithm>
#include <numeric>

namespace pillarfield {
namespace {

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

}  // namespace

double sum_along(const LineSimilarities& similar, const LinePath& path) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += similar(path[i], path[i + 1]);
  return sum;
}

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

}  // namespace pillarfield
