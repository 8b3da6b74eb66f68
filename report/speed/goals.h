#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/speed/run.h"

namespace pillarfield::report {

/// What speed is wanted, and what a run shows of it.
struct Goal {
  std::string what;
  bool at_least = true;  ///< else at most
  double limit = 0;
  std::optional<double> measured;  ///< unset where the run has no such row

  [[nodiscard]] bool is_met() const;
};

[[nodiscard]] std::vector<Goal> goals(const SpeedRun& run);

/// The goals as a table in Markdown.
[[nodiscard]] std::string goals_table(const std::vector<Goal>& goals);

}  // namespace pillarfield::report
