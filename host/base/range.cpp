#include "base/range.h"

#include <fmt/format.h>

namespace pillarfield {

bool Range::contains(double value) const {
  const bool above = open_low ? value > low : value >= low;
  const bool below = open_high ? value < high : value <= high;
  return above && below;
}

std::string Range::text() const {
  return fmt::format("a number in {}{}, {}{}", open_low ? '(' : '[', low, high,
                     open_high ? ')' : ']');
}

}  // namespace pillarfield
