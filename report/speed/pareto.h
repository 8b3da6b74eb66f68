#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace pillarfield::report {

/// What a way to do something costs, and how wrong it is. Of both less is better.
struct CostAndError {
  double cost = 0;
  double error = 0;
};

/// The points, from the cheapest on, than which none as cheap has a smaller error. Errors that
/// differ by no more than `resolution` of their size are the same; of those the cheapest stands.
[[nodiscard]] std::vector<std::size_t> pareto_front(std::span<const CostAndError> points,
                                                    double resolution);

}  // namespace pillarfield::report
