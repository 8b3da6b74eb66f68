#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace pillarfield {

/// The smallest value that at least a fraction `probability` (0..1) of the values do not exceed.
/// `values` are finite and not empty; reorders them.
template <class Value>
Value quantile(std::vector<Value>& values, double probability) {
  const auto rank = std::ceil(probability * static_cast<double>(values.size())) - 1;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::max(0.0, rank));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

template <class Value>
Value median(std::vector<Value>& values) {
  return quantile(values, 0.5);
}

}  // namespace pillarfield
