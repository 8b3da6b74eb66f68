#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/field/field_run.h"
#include "report/field/sweep_times.h"

/// docs/field.md, made from measurements. A section tells of one thing, draws its pictures, and
/// returns its text: Markdown that begins with a heading of level 2. Errors depend on nothing but
/// the code; times do.
namespace pillarfield::report {

struct FieldContext {
  std::filesystem::path docs;  ///< pictures go to docs / "pictures/field"
  std::vector<SceneResult> judging;
  std::vector<SceneResult> tuning;  ///< by the first method alone
  SweepTimes times;
};

[[nodiscard]] std::string field_goals_section(const FieldContext& context);
[[nodiscard]] std::string kinds_section(const FieldContext& context);
[[nodiscard]] std::string evidence_section(const FieldContext& context);
[[nodiscard]] std::string sweeps_section(const FieldContext& context);
[[nodiscard]] std::string field_coverage_section(const FieldContext& context);
[[nodiscard]] std::string impossible_section(const FieldContext& context);
[[nodiscard]] std::string residual_section(const FieldContext& context);
[[nodiscard]] std::string sets_section(const FieldContext& context);
[[nodiscard]] std::string contacts_section(const FieldContext& context);

}  // namespace pillarfield::report
