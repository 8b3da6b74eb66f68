#include "calibration/doctor/named_orders.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

namespace pillarfield {
namespace {

/// Lines that may belong to a mirrored part beyond those that are out of place.
constexpr std::uint32_t kReach = 2;

std::vector<std::uint32_t> lines_in_order(std::uint32_t lines) {
  std::vector<std::uint32_t> order(lines);
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

void add_interleaved(std::uint32_t lines, std::vector<NamedOrder>& named) {
  const std::uint32_t half = (lines + 1) / 2;
  std::vector<std::uint32_t> by_turns(lines);         // 0, half, 1, half + 1 ...
  std::vector<std::uint32_t> even_before_odd(lines);  // 0, 2, 4 ..., 1, 3 ...
  for (std::uint32_t i = 0; i < lines; ++i) {
    by_turns[i] = i % 2 == 0 ? i / 2 : half + i / 2;
    even_before_odd[i] = i < half ? 2 * i : 2 * (i - half) + 1;
  }
  named.push_back({"are interleaved: the halves lie by turns", by_turns});
  named.push_back({"are interleaved: even ones lie before odd ones", even_before_odd});
}

}  // namespace

std::vector<NamedOrder> named_orders(std::uint32_t lines, std::uint32_t first, std::uint32_t last) {
  std::vector<NamedOrder> named;
  const std::vector<std::uint32_t> given = lines_in_order(lines);
  NamedOrder swapped = {fmt::format("{} and {} are swapped", first, last), given};
  std::swap(swapped.order[first], swapped.order[last]);
  named.push_back(swapped);
  for (std::uint32_t more = 0; more <= 2 * kReach; ++more) {
    for (std::uint32_t before = more > kReach ? more - kReach : 0; before <= std::min(more, kReach);
         ++before) {
      const std::uint32_t end = last + (more - before) + 1;
      if (before > first || end > lines) continue;
      NamedOrder mirrored = {fmt::format("{} to {} are mirrored", first - before, end - 1), given};
      std::reverse(mirrored.order.begin() + (first - before), mirrored.order.begin() + end);
      named.push_back(mirrored);
    }
  }
  for (std::uint32_t middle = first + 1; middle <= last; ++middle) {
    NamedOrder parts = {
        fmt::format("{} to {} lie before {} to {}", middle, last, first, middle - 1), given};
    std::rotate(parts.order.begin() + first, parts.order.begin() + middle,
                parts.order.begin() + last + 1);
    named.push_back(parts);
  }
  add_interleaved(lines, named);
  return named;
}

}  // namespace pillarfield
