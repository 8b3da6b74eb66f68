#include "base/range.h"

#include <fmt/format.h>

namespace pillarfield {

bool Range::contains(double value) const {
  const bool above = open_low ? value > low : value >= low;
  const bool below = open_high ? value < high : value <= high;
  return above && below;
}

std::string Range::bounds() const {
  return fmt::format("{}{}, {}{}", open_low ? '(' : '[', low, high, open_high ? ')' : ']');
}

std::string Range::text() const { return "a number in " + bounds(); }

}  // namespace pillarfield
