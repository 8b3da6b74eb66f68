// What is known of friction: priors that are wrong, and what is learnt.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kPriors = R"(## Priors

What `contact` knows of friction before any reading is a log-normal distribution, median 1 and spread 0.5 unless said otherwise (`--friction-prior`). RMS error in region 3, counts, by true friction; a prior is wrong where its median is far from it.

)";

constexpr const char* kLearnt = R"(## Friction learnt

How often a narrow posterior is wrong. Contacts of {} pillars or more, each in each frame: how many have a posterior whose spread (the standard deviation of the friction's logarithm) is at most a limit, and which percentage of these have a median that is off by more than 10 or 20 %. First all contacts; then those whose
estimated shear uses half of that friction or more, Σ|s| ≥ 0.5 median ΣN, which readings tell; then those of which a fifth of the pillars truly slip.

)";

constexpr const char* kLearntEnd = R"(
Of the contacts without a pillar that slips {} have a spread of at most {:g}, and {} % of these are off by more than 20 %: where all of a contact sticks, its small ratios of shear to normal force are taken for friction. A limit on the spread does not tell such contacts from those that slip.
)";

/// Smaller contacts are fragments at the rim of others.
constexpr std::uint64_t kLeastPillars = 10;
constexpr double kLeastUsed = 0.5;
constexpr double kLeastSlipping = 0.2;
constexpr std::array kLimits = {0.02, 0.03, 0.05, 0.08, 0.12, 0.2};
constexpr double kOff = 0.1;

using field_study::LearntFriction;

/// Of contacts with narrow posteriors, how many are off.
struct Narrow {
  std::size_t narrow = 0;
  std::size_t off = 0;
  std::size_t far_off = 0;  ///< by twice as much

  void add(double error) {
    ++narrow;
    if (error > kOff) ++off;
    if (error > 2 * kOff) ++far_off;
  }
};

/// Contacts for which `holds`, whose spread is at most a limit.
Narrow narrow_of(const std::vector<HistoryResult>& results, double limit,
                 bool (*holds)(const LearntFriction&)) {
  Narrow sum;
  for (const HistoryResult& result : results) {
    for (const LearntFriction& learnt : result.learnt) {
      if (learnt.pillars < kLeastPillars || learnt.spread > limit || !holds(learnt)) continue;
      sum.add(std::abs(learnt.median / result.history.friction - 1));
    }
  }
  return sum;
}

std::string share_text(std::size_t part, std::size_t whole) {
  if (whole == 0) return "–";
  return percent_text(static_cast<double>(part) / static_cast<double>(whole));
}

}  // namespace

std::string prior_section(const FieldContext& context) {
  std::vector<std::string> header = {"prior"};
  for (const double friction : kFrictions) header.push_back(fmt::format("µ {:.1f}", friction));
  Table table("l" + std::string(kFrictions.size(), 'r'), header);
  const auto add = [&](std::size_t method) {
    std::vector<std::string> cells = {methods()[method].name};
    for (const double friction : kFrictions) {
      cells.push_back(rms_text(pooled(context.histories, method, of_friction(friction))));
    }
    table.add(cells);
  };
  for (std::size_t i = kFirstPrior; i < methods().size(); ++i) add(i);
  add(kBounded);
  add(kGiven);
  add(kPaper);
  return kPriors + table.text();
}

std::string learnt_table(const std::vector<HistoryResult>& results) {
  constexpr std::array<bool (*)(const LearntFriction&), 3> kGroups = {
      [](const LearntFriction&) { return true; },
      [](const LearntFriction& learnt) { return learnt.used >= kLeastUsed; },
      [](const LearntFriction& learnt) { return learnt.slipping >= kLeastSlipping; }};
  Table table("rrrrrrrrrr", {"spread at most", "all", "10 %", "20 %", "half used", "10 %", "20 %",
                             "a fifth slips", "10 %", "20 %"});
  const auto add = [&](const std::string& name, double limit) {
    std::vector<std::string> cells = {name};
    for (const auto holds : kGroups) {
      const Narrow found = narrow_of(results, limit, holds);
      cells.push_back(fmt::format("{}", found.narrow));
      cells.push_back(share_text(found.off, found.narrow));
      cells.push_back(share_text(found.far_off, found.narrow));
    }
    table.add(cells);
  };
  for (const double limit : kLimits) add(fmt::format("{:.2f}", limit), limit);
  add("any", std::numeric_limits<double>::infinity());
  return table.text();
}

std::string learnt_section(const FieldContext& context) {
  constexpr double kNarrowLimit = 0.05;
  const Narrow sticking =
      narrow_of(context.histories, kNarrowLimit,
                [](const LearntFriction& learnt) { return learnt.slipping == 0; });
  return fmt::format(fmt::runtime(kLearnt), kLeastPillars) + learnt_table(context.histories) +
         fmt::format(fmt::runtime(kLearntEnd), sticking.narrow, kNarrowLimit,
                     share_text(sticking.far_off, sticking.narrow));
}

}  // namespace pillarfield::report
