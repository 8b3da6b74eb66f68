#pragma once

#include <string>
#include <vector>

namespace pillarfield::viewer {

struct Tick {
  double value;
  std::string label;
};

/// Round values in [low, high] (low < high), steps of 1, 2 or 5 times a power of ten, at most
/// `most` (>= 1) of them. Labels have just the digits that tell them apart, the same number of
/// decimals all ("0", "0.5", "1.0"), and a real minus sign; "2e6" and "2e−7" beyond six digits.
[[nodiscard]] std::vector<Tick> ticks(double low, double high, int most);

/// 1, 2 or 5 times a power of ten, the least not below `value` (1e-300..1e300).
[[nodiscard]] double nice_ceiling(double value);

/// The same in smaller steps: 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6 or 8 times a power of ten.
[[nodiscard]] double round_ceiling(double value);

/// A number for a reader: three significant digits, SI-free, "0.0123", "12.3", "1230", a real minus
/// sign; "0", and "1.23e7" from ten million on or below a ten-thousandth; "–" for what is no
/// number.
[[nodiscard]] std::string three_digits(double value);

}  // namespace pillarfield::viewer
