// Skins by size, by fraction in contact and by region, and the options of a plan, on a square metre
// that is loaded everywhere.

#include <fmt/format.h>

#include <cstdint>

#include "bench/cases/cases.h"
#include "bench/frame_solver.h"
#include "bench/timing/interleaved_timing.h"
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

void add_plan_case(const Session& session, const std::string& name, const SolverPlan& plan,
                   const ProcessorTuning& tuning = {}) {
  add_case(name, [&session, plan, tuning] { return time_solve(session, plan, {}, {}, tuning); });
}

SolverPlan plan_with(std::string_view stage) {
  SolverPlan plan = bare_plan(kSquareMetre);
  add_stage(plan, stage);
  return plan;
}

/// An effect of a real sensor on a calibrated skin, in turns with the same skin without it. Turns
/// last 64 ms, so that caches and processor are as in a stream.
Measurement time_effect(const Session& session, double percent, std::string_view effect) {
  const SolverPlan calibrated = plan_with("calibrated");
  SolverPlan plan = calibrated;
  add_stage(plan, effect);
  const Frames frames(plan.skin, plan.sensel_type, {Touch::mixed, percent / 100});
  FrameSolver without(session.solver, calibrated, frames);
  FrameSolver with(session.solver, plan, frames);
  InterleavedTiming timing;
  const std::size_t without_entry = timing.add([&](int count) { without.run(count); });
  const std::size_t with_entry = timing.add([&](int count) { with.run(count); });
  TimingLength length = session.length;
  length.turn_seconds = 64e-3;
  timing.run(length);
  Measurement measured = measurement_of(timing, with_entry, plan);
  measured.counters["over_none"] = timing.ratio(with_entry, without_entry);
  measured.label = fmt::format("{} frames, {}", frames.size(), with.device());
  return measured;
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
        return time_solve(session, plan_with(stage), scenario);
      });
    }
  }
  for (const NamedTouch& each : kTouches) {
    add_case(fmt::format("regions/{}", each.name), [&session, touch = each.touch] {
      return time_solve(session, plan_with("none"), {touch, 1});
    });
  }
}

void add_plan_cases(const Session& session) {
  add_plan_case(session, "type/u16", bare_plan(kSquareMetre, SenselType::u16));
  add_plan_case(session, "type/f32", bare_plan(kSquareMetre, SenselType::f32));
  for (const int lanes : {1, 2, 4, 8, 16}) {
    add_plan_case(session, fmt::format("lanes/{}", lanes), plan_with("none"), {.lanes = lanes});
  }
  // The planes of a square metre are made only when the case runs.
  for (const std::string_view stage : stage_names()) {
    add_case(fmt::format("stage/{}", stage),
             [&session, stage] { return time_solve(session, plan_with(stage)); });
  }
  for (const double percent : {8.0, 100.0}) {
    for (const std::string_view effect : {"none", "curve", "shear_coefficient", "leak", "memory",
                                          "wires", "pillar_leak", "lean", "bending", "sensor"}) {
      add_case(fmt::format("sensor/{}/{}", percent, effect),
               [&session, percent, effect] { return time_effect(session, percent, effect); });
    }
  }
}

}  // namespace pillarfield::bench
