#include "report/speed/pareto.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace pillarfield::report {

std::vector<std::size_t> pareto_front(std::span<const CostAndError> points, double resolution) {
  std::vector<std::size_t> by_cost(points.size());
  std::iota(by_cost.begin(), by_cost.end(), std::size_t{0});
  std::ranges::stable_sort(
      by_cost, {}, [&](std::size_t i) { return std::tuple(points[i].cost, points[i].error); });
  std::vector<std::size_t> front;
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t i : by_cost) {
    if (!(points[i].error < (1 - resolution) * least)) continue;
    front.push_back(i);
    least = points[i].error;
  }
  return front;
}

}  // namespace pillarfield::report
