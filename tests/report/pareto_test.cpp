// The Pareto front of made-up points.

#include "report/speed/pareto.h"

#include <gtest/gtest.h>

namespace pillarfield::report {
namespace {

using Places = std::vector<std::size_t>;

TEST(ParetoFront, HasWhatNothingIsAsCheapAndMoreExactThan) {
  const CostAndError points[] = {{4, 1.0}, {1, 3.0}, {2, 2.0}, {3, 2.5}, {2.5, 2.0}, {5, 0.5}};
  EXPECT_EQ(pareto_front(points, 0), (Places{1, 2, 0, 5}));
}

TEST(ParetoFront, TakesErrorsWithinTheResolutionForTheSame) {
  const CostAndError points[] = {{1, 1.0}, {2, 0.998}, {3, 0.996}, {4, 0.99}};
  EXPECT_EQ(pareto_front(points, 0.003), (Places{0, 2, 3}));
  EXPECT_EQ(pareto_front(points, 0.02), (Places{0}));
}

TEST(ParetoFront, OfEqualCostsHasTheMoreExact) {
  const CostAndError points[] = {{1, 2.0}, {1, 1.0}, {1, 1.0}};
  EXPECT_EQ(pareto_front(points, 0), (Places{1}));
}

TEST(ParetoFront, OfNothingIsNothing) { EXPECT_TRUE(pareto_front({}, 0).empty()); }

}  // namespace
}  // namespace pillarfield::report
