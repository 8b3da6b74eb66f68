#pragma once

#include <algorithm>
#include <vector>

namespace pillarfield {

/// The two keys of a path between which a time lies, and how far; before the first key and after
/// the last one both are that key.
template <class Key>
struct PathPlace {
  const Key& from;
  const Key& to;
  double fraction;  ///< 0 at from, 1 at to
};

template <class Key>
[[nodiscard]] PathPlace<Key> place_on(const std::vector<Key>& path, double time_s) {
  const auto next = std::upper_bound(path.begin(), path.end(), time_s,
                                     [](double t, const Key& key) { return t < key.time_s; });
  if (next == path.begin()) return {path.front(), path.front(), 0};
  if (next == path.end()) return {path.back(), path.back(), 0};
  const Key& from = *(next - 1);
  return {from, *next, (time_s - from.time_s) / (next->time_s - from.time_s)};
}

}  // namespace pillarfield
