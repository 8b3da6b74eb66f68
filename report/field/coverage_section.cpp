// Whether the stated uncertainty of pillars of region 3 is true.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

using field_study::intervals;
using field_study::kIntervals;

constexpr const char* kIntroduction = R"(## Coverage

The share of the pillars of region 3 of which a stated 95 % holds the truth, `contact` with its default prior: of the components from `_low` to `_high` (the estimate ± 1.96 standard deviations), of magnitude and angles what lies from the low to the high end. The ends
leave out the noise of the shear component that does not depend on the normal force; one row adds 1.96 deviations of it to them. The last rows are of recordings with {} such pillars or more.

)";

constexpr double kLeastTrue = 0.88;

std::vector<double> shares_of(const std::vector<HistoryResult>& results, std::size_t method,
                              std::size_t interval) {
  std::vector<double> shares;
  for (const HistoryResult& result : results) {
    if (result.open() < kEnoughPillars) continue;
    shares.push_back(result.by_method[method].coverage(interval));
  }
  return shares;
}

}  // namespace

double share_of_true_recordings(const std::vector<HistoryResult>& results, std::size_t method,
                                std::size_t interval) {
  const std::vector<double> shares = shares_of(results, method, interval);
  const auto good =
      std::count_if(shares.begin(), shares.end(), [](double share) { return share >= kLeastTrue; });
  return static_cast<double>(good) / static_cast<double>(shares.size());
}

std::string field_coverage_section(const FieldContext& context) {
  std::vector<std::string> header = {"held, %"};
  std::vector<std::string> good = {"recordings with 88 to 100 %, %"};
  std::vector<std::string> least = {"least of a recording"};
  for (std::size_t i = 0; i < kIntervals; ++i) {
    header.emplace_back(intervals()[i].name);
    good.push_back(percent_text(share_of_true_recordings(context.histories, kContact, i)));
    const std::vector<double> shares = shares_of(context.histories, kContact, i);
    least.push_back(percent_text(*std::min_element(shares.begin(), shares.end())));
  }
  Table table("l" + std::string(kIntervals, 'r'), header);
  const auto add = [&](const std::string& name, const auto& holds) {
    const field_study::Score score = pooled(context.histories, kContact, holds);
    std::vector<std::string> cells = {name};
    for (std::size_t i = 0; i < kIntervals; ++i) cells.push_back(percent_text(score.coverage(i)));
    table.add(cells);
  };
  for (const double friction : kFrictions) {
    add(fmt::format("friction {:.1f}", friction), of_friction(friction));
  }
  const auto any = [](const HistoryResult&) { return true; };
  add("all", any);
  const field_study::Score all = pooled(context.histories, kContact, any);
  std::vector<std::string> widened = {"all, ends widened by noise"};
  for (std::size_t i = 0; i < kIntervals; ++i) {
    const auto held = static_cast<double>(all.held_with_noise[i]);
    widened.push_back(percent_text(held / static_cast<double>(all.open)));
  }
  table.add(widened);
  table.add(good);
  table.add(least);
  return fmt::format(fmt::runtime(kIntroduction), kEnoughPillars) + table.text();
}

}  // namespace pillarfield::report
