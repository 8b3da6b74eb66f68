#pragma once

#include <cmath>
#include <utility>

namespace pillarfield {

/// Argument of the minimum of a unimodal function, by golden-section search.
template <class Function>
double least_of(Function function, double low, double high, double accuracy) {
  const double section = (std::sqrt(5.0) - 1) / 2;
  double left = high - section * (high - low);
  double right = low + section * (high - low);
  double at_left = function(left);
  double at_right = function(right);
  while (high - low > accuracy) {
    if (at_left < at_right) {
      high = std::exchange(right, left);
      at_right = at_left;
      left = high - section * (high - low);
      at_left = function(left);
    } else {
      low = std::exchange(left, right);
      at_left = at_right;
      right = low + section * (high - low);
      at_right = function(right);
    }
  }
  return (low + high) / 2;
}

}  // namespace pillarfield
