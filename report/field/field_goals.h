#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/field/field_run.h"

namespace pillarfield::report {

/// What is wanted of the ratio of RMS errors to the paper's midpoint, in every scene of a kind, and
/// what the scenes show. Scenes with fewer than kEnoughPillars ambiguous pillars have no ratio.
struct FieldGoal {
  std::string what;
  double limit = 0;
  std::size_t scenes = 0;
  Pooled pooled;
  double worst = 0;
  std::string worst_scene;
  std::size_t missed = 0;    ///< scenes above the limit
  std::size_t by_noise = 0;  ///< of them those where noise alone is above it
  std::size_t left = 0;      ///< of the others those with less than half of the pillars resolved
  std::size_t unasked = 0;   ///< of these, those with so few open pillars that none is asked
  double most_unasked_counts = 0;  ///< the largest RMS error of their midpoints
  std::size_t otherwise = 0;       ///< missed ones that are neither
  double most_over_noise = 0;      ///< the largest error of these, by that of noise alone
  std::string misses;              ///< what the missed ones are, by shape; empty without any

  [[nodiscard]] bool is_met() const { return scenes > 0 && missed == 0; }
};

[[nodiscard]] std::vector<FieldGoal> field_goals(const std::vector<SceneResult>& judging);

/// Of the scenes with enough ambiguous pillars: the least and the largest share whose true normal
/// force lies in the stated band, and how many scenes lie below 93 % and above 99 %.
struct CoverageGoal {
  std::size_t scenes = 0;
  double least = 1;
  std::string least_scene;
  double most = 0;
  std::size_t below = 0;
  std::size_t above = 0;
  std::size_t resolved = 0;        ///< scenes most of whose pillars are
  std::size_t resolved_below = 0;  ///< of these below 93 %
  std::size_t by_chance = 0;       ///< of those below: independent errors of 95 % could do as much
  std::size_t whole = 0;           ///< of those above: most pillars are not resolved
};
[[nodiscard]] CoverageGoal coverage_goal(const std::vector<SceneResult>& judging);

}  // namespace pillarfield::report
