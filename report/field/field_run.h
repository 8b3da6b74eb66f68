#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/core/field_study.h"
#include "tests/core/field_study_histories.h"
#include "tests/core/field_study_scenes.h"

namespace pillarfield::report {

/// Frictions of the histories.
inline constexpr std::array kFrictions = {0.8, 1.2, 1.6, 2.2, 3.0, 4.5};

/// The largest friction that goals are about: larger ones are rare.
inline constexpr double kLargestUsual = 3.0;

/// Pillars of region 3 that a recording needs for a ratio or a share of its own.
inline constexpr std::size_t kEnoughPillars = 30;

/// A way to estimate forces.
struct Method {
  std::string name;
  std::function<void(SolverPlan& plan, double true_friction)> set;
};

/// All methods; the first ones in the order of the indices below, then the priors.
[[nodiscard]] const std::vector<Method>& methods();
inline constexpr std::size_t kDirect = 0;
inline constexpr std::size_t kMiddle = 1;
inline constexpr std::size_t kPaper = 2;
inline constexpr std::size_t kContact = 3;
inline constexpr std::size_t kUnrelated = 4;
inline constexpr std::size_t kGiven = 5;
inline constexpr std::size_t kBounded = 6;
inline constexpr std::size_t kLower = 7;
inline constexpr std::size_t kFirstPrior = 8;

/// Scores of one recording.
struct Result {
  std::vector<field_study::Score> by_method;  ///< as methods()
  field_study::Score nearest;                 ///< the error that noise alone leaves

  [[nodiscard]] std::size_t open() const { return nearest.open; }
  /// The RMS error of a method over that of the paper's equations; 0 without open pillars.
  [[nodiscard]] double to_paper(std::size_t method) const;
};

struct HistoryResult : Result {
  field_study::History history;
  std::vector<field_study::LearntFriction> learnt;
};

/// Of a contact of closed form; by the methods before kBounded alone.
struct ClosedFormResult : Result {
  field_study::ClosedForm scene;
};

/// Solves all histories by all methods; two minutes of processor time. `scenes` has key.png.
[[nodiscard]] std::vector<HistoryResult> measure_histories(const std::filesystem::path& scenes);
[[nodiscard]] std::vector<ClosedFormResult> measure_closed_forms();

/// Scores of those results for which `holds`, their pillars taken together.
template <class Results, class Holds>
[[nodiscard]] field_study::Score pooled(const Results& results, std::size_t method, Holds holds) {
  field_study::Score sum;
  for (const auto& result : results) {
    if (holds(result)) sum += result.by_method.at(method);
  }
  return sum;
}

/// The same of what noise alone leaves.
template <class Results, class Holds>
[[nodiscard]] field_study::Score pooled_nearest(const Results& results, Holds holds) {
  field_study::Score sum;
  for (const auto& result : results) {
    if (holds(result)) sum += result.nearest;
  }
  return sum;
}

/// Whether a history is of this friction.
[[nodiscard]] inline auto of_friction(double friction) {
  return [friction](const HistoryResult& result) { return result.history.friction == friction; };
}

/// Kinds of closed forms, as tables have them: "rounded, spin and turn" and so on.
struct Kind {
  std::string name;
  std::function<bool(const field_study::ClosedForm&)> holds;
};
[[nodiscard]] const std::vector<Kind>& kinds();

/// "1.23"; "–" where no pillar is open.
[[nodiscard]] std::string rms_text(const field_study::Score& score);
/// "12.3": 100 times a share.
[[nodiscard]] std::string percent_text(double share);

}  // namespace pillarfield::report
