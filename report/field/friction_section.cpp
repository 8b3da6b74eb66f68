// What is known of friction: priors that are wrong, and what is learnt.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
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

How often a posterior that is narrow is wrong. Contacts of {} pillars or more, each in each frame: how many have a posterior whose spread (the standard deviation of the friction's logarithm) is at most a limit, and which share of these has a median that is off by more than 10 %, by true friction. A contact that
has not slipped yet shows no friction, so a good limit leaves it out.

)";

/// Smaller contacts are fragments at the rim of others.
constexpr std::uint64_t kLeastPillars = 10;
constexpr std::array kLimits = {0.02, 0.03, 0.05, 0.08, 0.12, 0.2};
constexpr double kOff = 0.1;

/// Narrow posteriors of one friction or of all.
struct Narrow {
  std::size_t contacts = 0;
  std::size_t narrow = 0;
  std::size_t off = 0;
  std::size_t far_off = 0;  ///< by twice as much

  void add(const HistoryResult& result, double limit) {
    for (const field_study::LearntFriction& learnt : result.learnt) {
      if (learnt.pillars < kLeastPillars) continue;
      ++contacts;
      if (learnt.spread > limit) continue;
      const double error = std::abs(learnt.median / result.history.friction - 1);
      ++narrow;
      if (error > kOff) ++off;
      if (error > 2 * kOff) ++far_off;
    }
  }
};

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
  std::vector<std::string> header = {"spread at most", "narrow, % of contacts", "off by 10 %, %",
                                     "by 20 %, %"};
  for (const double friction : kFrictions) header.push_back(fmt::format("µ {:.1f}", friction));
  Table table("r" + std::string(header.size() - 1, 'r'), header);
  for (const double limit : kLimits) {
    Narrow all;
    std::vector<std::string> by_friction;
    for (const double friction : kFrictions) {
      Narrow one;
      for (const HistoryResult& result : results) {
        if (result.history.friction == friction) one.add(result, limit);
      }
      by_friction.push_back(fmt::format("{} of {}", one.off, one.narrow));
      all.contacts += one.contacts;
      all.narrow += one.narrow;
      all.off += one.off;
      all.far_off += one.far_off;
    }
    std::vector<std::string> cells = {
        fmt::format("{:.2f}", limit), share_text(all.narrow, all.contacts),
        share_text(all.off, all.narrow), share_text(all.far_off, all.narrow)};
    cells.insert(cells.end(), by_friction.begin(), by_friction.end());
    table.add(cells);
  }
  return table.text();
}

std::string learnt_section(const FieldContext& context) {
  return fmt::format(fmt::runtime(kLearnt), kLeastPillars) + learnt_table(context.histories);
}

}  // namespace pillarfield::report
