#pragma once

#include <vector>

#include "lab/studies/hard_cases.h"

/// Accuracy of kernels/pillar, measured against the oracle.
namespace pillarfield::hard_cases {

/// Solution of an example, in either precision.
struct Outcome {
  oracle::Force force;
  std::vector<double> outputs;  ///< force, direction, deviations and ends of the intervals
  int status = 0;
};
[[nodiscard]] Outcome solve(const Example& example, Estimator estimator, Precision precision);

/// The largest error of a component of the force, against the oracle's answer to these readings, in
/// epsilons of the force's magnitude, or in smallest subnormal numbers where these are larger; 0
/// where the oracle has no answer: with sensels saturated or missing and fewer than three usable.
[[nodiscard]] double error_of(const Outcome& outcome, const Example& example, Estimator estimator,
                              Precision precision);

/// The condition number of an example's force (oracle::condition_number); not a number where an
/// equation is 0/0, and 0 where the oracle has no answer.
[[nodiscard]] double condition_of(const Example& example, Estimator estimator, Precision precision);

/// The same for the paper's estimator where (5) always takes sensels 1 and 3, as the paper assigns
/// them; in regions 2 to 4 as condition_of.
[[nodiscard]] double condition_as_assigned(const Example& example, Precision precision);

}  // namespace pillarfield::hard_cases
