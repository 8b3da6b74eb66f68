#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "report/field/cost.h"
#include "report/field/field_run.h"

/// docs/field.md, made from measurements. A section tells of one thing, draws its pictures, and
/// returns its text: Markdown that begins with a heading of level 2. Errors depend on nothing but
/// the code; times do.
namespace pillarfield::report {

struct FieldContext {
  std::filesystem::path docs;    ///< pictures go to docs / "pictures/field"
  std::filesystem::path scenes;  ///< the folder of the scenes
  std::vector<HistoryResult> histories;
  std::vector<ClosedFormResult> closed_forms;
  ContactCost cost;
};

[[nodiscard]] std::string field_goals_section(const FieldContext& context);
[[nodiscard]] std::string error_section(const FieldContext& context);
[[nodiscard]] std::string prior_section(const FieldContext& context);
[[nodiscard]] std::string learnt_section(const FieldContext& context);
[[nodiscard]] std::string field_coverage_section(const FieldContext& context);
[[nodiscard]] std::string cost_section(const FieldContext& context);
[[nodiscard]] std::string closed_forms_section(const FieldContext& context);
[[nodiscard]] std::string impossible_section(const FieldContext& context);
[[nodiscard]] std::string recordings_section(const FieldContext& context);

/// The share of the recordings with kEnoughPillars or more in which an interval of a method holds
/// the truth for 88 to 100 % of the pillars of region 3.
[[nodiscard]] double share_of_true_recordings(const std::vector<HistoryResult>& results,
                                              std::size_t method, std::size_t interval);

/// The table of learnt frictions alone, for whoever chooses when a friction is reported.
[[nodiscard]] std::string learnt_table(const std::vector<HistoryResult>& results);

}  // namespace pillarfield::report
