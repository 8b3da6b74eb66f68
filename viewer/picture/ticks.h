#pragma once

#include <string>
#include <vector>

namespace pillarfield::viewer {

struct Tick {
  double value;
  std::string label;
};

/// Round values in [low, high] (low < high), steps of 1, 2 or 5 times a power of ten, at most
/// `most` of them; labels with just the digits they need, and a real minus sign.
[[nodiscard]] std::vector<Tick> ticks(double low, double high, int most);

/// 1, 2 or 5 times a power of ten, the least not below `value` (> 0).
[[nodiscard]] double nice_ceiling(double value);

/// A number for a reader: three significant digits, SI-free, "0.0123", "12.3", "1230".
[[nodiscard]] std::string three_digits(double value);

}  // namespace pillarfield::viewer
