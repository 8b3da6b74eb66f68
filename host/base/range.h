#pragma once

#include <string>

namespace pillarfield {

struct Range {
  double low = 0;
  double high = 0;
  bool open_low = false;
  bool open_high = false;

  [[nodiscard]] bool contains(double value) const;  ///< false for NaN
  [[nodiscard]] std::string bounds() const;         ///< "[0, 1)"
  [[nodiscard]] std::string text() const;           ///< "a number in [0, 1)"
};

}  // namespace pillarfield
