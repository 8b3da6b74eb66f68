#include "base/nearest_word.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pillarfield {
namespace {

/// The optimal string alignment distance.
std::size_t edits_between(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> edits(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        edits[i][j] = i + j;
        continue;
      }
      const std::size_t replaced = edits[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      edits[i][j] = std::min({edits[i - 1][j] + 1, edits[i][j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        edits[i][j] = std::min(edits[i][j], edits[i - 2][j - 2] + 1);
      }
    }
  }
  return edits[a.size()][b.size()];
}

/// True if the longer name ends with the shorter one after '_', as "sensel_pitch_mm" and
/// "pitch_mm".
bool ends_alike(std::string_view a, std::string_view b) {
  if (a.size() < b.size()) std::swap(a, b);
  return a.size() > b.size() && b.size() >= 3 && a.ends_with(b) &&
         a[a.size() - b.size() - 1] == '_';
}

/// The candidate that begins with `word`, ends like it or has the smallest distance; empty where
/// that is above a third of the word plus 1.
std::string nearest_word(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongest = 40;  // The table is quadratic, and all names are shorter.
  if (word.size() > kLongest) return {};
  std::string nearest;
  std::size_t too_many = word.size() / 3 + 2;
  for (const std::string& candidate : candidates) {
    const bool begins =
        (word.size() >= 3 && candidate.starts_with(word)) || ends_alike(word, candidate);
    const std::size_t edits = begins ? 1 : edits_between(word, candidate);
    if (edits >= too_many) continue;
    too_many = edits;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace

std::string suggestion(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

}  // namespace pillarfield
