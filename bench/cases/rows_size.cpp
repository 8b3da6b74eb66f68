// Skins of all sizes, all shares of contact and all kinds of load.

#include <fmt/format.h>

#include <cstdint>

#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"

namespace pillarfield::bench {
namespace {

/// Patches of 10^3, 10^4, 10^5 pillars, a square metre, 10^6 and 10^7 pillars, nearly.
constexpr std::uint32_t kSides[] = {32, 100, 316, kSquareMetre, 1000, 3162};

struct NamedTouch {
  const char* name;
  Touch touch;
};
constexpr NamedTouch kTouches[] = {{"one", Touch::one},       {"two", Touch::two},
                                   {"three", Touch::three},   {"four", Touch::four},
                                   {"silent", Touch::silent}, {"mixed", Touch::mixed},
                                   {"worst", Touch::worst}};

SolverPlan square_metre(const char* stage) {
  SolverPlan plan = bare_plan(kSquareMetre);
  add_stage(plan, stage);
  return plan;
}

}  // namespace

void add_size_rows(const Session& session) {
  for (const std::uint32_t side : kSides) {
    const SolverPlan plan = bare_plan(side);
    add_row(fmt::format("size/{}", plan.skin.pillars()),
            [&session, plan] { return race_solve(session, plan); });
  }
  for (const double percent : {0.1, 1.0, 10.0, 100.0}) {
    for (const char* const stage : {"none", "all"}) {
      const char* const what = stage == std::string_view("none") ? "bare" : "all";
      add_row(fmt::format("contact/{}/{}", percent, what), [&session, percent, stage] {
        const Scenery scenery{Touch::mixed, percent / 100};
        return race_solve(session, square_metre(stage), scenery);
      });
    }
  }
  for (const NamedTouch& each : kTouches) {
    add_row(fmt::format("regions/{}", each.name), [&session, touch = each.touch] {
      return race_solve(session, square_metre("none"), {touch, 1});
    });
  }
}

}  // namespace pillarfield::bench
