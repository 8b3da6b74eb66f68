// Skins by size, by fraction in contact and by region.

#include <fmt/format.h>

#include <cstdint>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// Square roots of about 10^3, 10^4, 10^5 pillars, of a square metre, of 10^6 and 10^7 pillars.
constexpr std::uint32_t kSides[] = {32, 100, 316, kSquareMetre, 1000, 3162};

struct NamedTouch {
  const char* name;
  Touch touch;
};
constexpr NamedTouch kTouches[] = {
    {"one", Touch::one},   {"two", Touch::two},     {"three", Touch::three}, {"four", Touch::four},
    {"idle", Touch::idle}, {"mixed", Touch::mixed}, {"worst", Touch::worst}};

SolverPlan square_metre(const char* stage) {
  SolverPlan plan = bare_plan(kSquareMetre);
  add_stage(plan, stage);
  return plan;
}

}  // namespace

void add_size_cases(const Session& session) {
  for (const std::uint32_t side : kSides) {
    const SolverPlan plan = bare_plan(side);
    add_case(fmt::format("size/{}", plan.skin.pillars()),
             [&session, plan] { return time_solve(session, plan); });
  }
  for (const double percent : {0.1, 1.0, 10.0, 100.0}) {
    for (const char* const stage : {"none", "all"}) {
      const char* const what = stage == std::string_view("none") ? "bare" : "all";
      add_case(fmt::format("contact/{}/{}", percent, what), [&session, percent, stage] {
        const Scenario scenario{Touch::mixed, percent / 100};
        return time_solve(session, square_metre(stage), scenario);
      });
    }
  }
  for (const NamedTouch& each : kTouches) {
    add_case(fmt::format("regions/{}", each.name), [&session, touch = each.touch] {
      return time_solve(session, square_metre("none"), {touch, 1});
    });
  }
}

}  // namespace pillarfield::bench
