#pragma once

#include <string>
#include <vector>

namespace pillarfield::viewer {

struct Tick {
  double value;
  std::string label;
};

/// Round values in [low, high] (low < high), at most `most` (>= 1), in steps of 1, 2 or 5 times a
/// power of ten. Labels share the least sufficient number of decimals ("0", "0.5", "1.0") and use a
/// real minus sign; "2e6" and "2e−7" beyond six digits.
[[nodiscard]] std::vector<Tick> ticks(double low, double high, int most);

/// The least of 1, 2 or 5 times a power of ten not below `value` (1e-300..1e300).
[[nodiscard]] double nice_ceiling(double value);

/// The least of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten not below `value`.
[[nodiscard]] double round_ceiling(double value);

/// Three significant digits with a real minus sign: "0.0123", "12.3", "1230", "0"; "1.23e7" from
/// 1e7 on and below 1e-4; "–" for NaN.
[[nodiscard]] std::string three_digits(double value);

}  // namespace pillarfield::viewer
