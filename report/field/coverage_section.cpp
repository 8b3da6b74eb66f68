// Whether the stated uncertainty of ambiguous pillars is true.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Coverage

The share of the pillars of region 3 whose true normal force lies in the stated band: for those that neighbours resolved (status bit 7) the estimate ± 1.96 of its standard deviation, for
the others the whole segment, from nothing to twice the middle, and 1.96 standard deviations of that end. The least is that of scenes with {enough} such pillars or more. Nothing is said by the scenes.

)";

std::string percent(std::size_t part, std::size_t whole) {
  if (whole == 0) return "–";
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string least_of(const std::vector<SceneResult>& results, const Kind& kind) {
  double least = 1;
  bool any = false;
  for (const SceneResult& result : results) {
    if (!result.counts() || !kind.holds(result.scene)) continue;
    any = true;
    least = std::min(least, result.field().coverage());
  }
  return any ? fmt::format("{:.1f}", 100 * least) : "–";
}

}  // namespace

std::string field_coverage_section(const FieldContext& context) {
  Table table("lrrrrr", {"", "resolved, % of region 3", "held, %: resolved", "not resolved", "all",
                         "least scene"});
  for (const Kind& kind : kinds()) {
    const auto score = pool_method(context.judging, kind, 0).solved;
    table.add({kind.name, percent(score.resolved, score.open),
               percent(score.resolved_covered, score.resolved),
               percent(score.covered - score.resolved_covered, score.open - score.resolved),
               percent(score.covered, score.open), least_of(context.judging, kind)});
  }
  return fmt::format(kIntroduction, fmt::arg("enough", kEnoughPillars)) + table.text();
}

}  // namespace pillarfield::report
