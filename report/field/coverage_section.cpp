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
the others the whole segment, from nothing to twice the middle, and 1.96 standard deviations of that end. Nothing is said by the scenes. The last columns are of scenes with {enough} such pillars or more: how many are held
by less than 93 %, by 93 to 99 %, by more where most pillars are resolved, and by more where they are not; and the least share.

)";

std::string percent(std::size_t part, std::size_t whole) {
  if (whole == 0) return "–";
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(part) / static_cast<double>(whole));
}

/// Scenes by the share that their bands hold.
struct Shares {
  int below = 0;
  int within = 0;
  int above = 0;       ///< of which most pillars are resolved
  int unresolved = 0;  ///< above, and most are not
  double least = 1;

  void add(const field_study::Score& score) {
    const double share = score.coverage();
    least = std::min(least, share);
    if (share < 0.93) {
      ++below;
    } else if (share <= 0.99) {
      ++within;
    } else {
      ++(2 * score.resolved < score.open ? unresolved : above);
    }
  }
  [[nodiscard]] int scenes() const { return below + within + above + unresolved; }
};

Shares shares_of(const std::vector<SceneResult>& results, const Kind& kind) {
  Shares shares;
  for (const SceneResult& result : results) {
    if (result.counts() && kind.holds(result.scene)) shares.add(result.field());
  }
  return shares;
}

}  // namespace

std::string field_coverage_section(const FieldContext& context) {
  Table table("lrrrrrrrrr",
              {"", "resolved, % of region 3", "held, %: resolved", "not resolved", "all",
               "scenes < 93 %", "93 to 99 %", "more, resolved", "more, not", "least, %"});
  for (const Kind& kind : kinds()) {
    const auto score = pool_method(context.judging, kind, 0).solved;
    const Shares shares = shares_of(context.judging, kind);
    table.add({kind.name, percent(score.resolved, score.open),
               percent(score.resolved_covered, score.resolved),
               percent(score.covered - score.resolved_covered, score.open - score.resolved),
               percent(score.covered, score.open), fmt::format("{}", shares.below),
               fmt::format("{}", shares.within), fmt::format("{}", shares.above),
               fmt::format("{}", shares.unresolved),
               shares.scenes() > 0 ? fmt::format("{:.1f}", 100 * shares.least) : "–"});
  }
  return fmt::format(kIntroduction, fmt::arg("enough", kEnoughPillars)) + table.text();
}

}  // namespace pillarfield::report
