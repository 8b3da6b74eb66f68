// Time of the ways to solve a square metre with 5 % in contact, for docs/speed_and_error.md.

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "bench/cases/cases.h"
#include "bench/contact_frames.h"
#include "bench/frame_solver.h"
#include "bench/timing/interleaved_timing.h"
#include "bench/timing/solve_timing.h"
#include "bench/variants.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFrames = 16;  ///< 40 MB

/// Knowledge of the sensor: none, tares and gains, or all of its effects.
constexpr std::string_view kKnowledge[] = {"none", "calibrated", "sensor"};

struct Way {
  std::string_view name;
  Estimator estimator;
  bool uncertainty;
};
constexpr Way kWays[] = {{"paper", Estimator::paper, false},
                         {"direct", Estimator::direct, false},
                         {"direct_and_deviations", Estimator::direct, true},
                         {"contact", Estimator::contact, false},
                         {"contact_and_deviations", Estimator::contact, true}};

Measurement time_way(const Session& session, std::string_view knowledge, const Way& way,
                     const ContactFrames& contacts) {
  SolverPlan plan = contacts.plan();
  add_stage(plan, knowledge);
  plan.estimator = way.estimator;
  plan.uncertainty = way.uncertainty;
  FrameSolver bare(session.solver, contacts.plan(), contacts.frames());
  FrameSolver solver(session.solver, plan, contacts.frames());
  InterleavedTiming timing;
  const std::size_t bare_entry = timing.add([&](int count) { bare.run(count); });
  const std::size_t entry = timing.add([&](int count) { solver.run(count); });
  timing.run(session.length);
  Measurement measured = measurement_of(timing, entry, plan);
  measured.counters["over_bare"] = timing.ratio(entry, bare_entry);
  return measured;
}

}  // namespace

void add_choice_cases(const Session& session) {
  const auto frames = std::make_shared<std::optional<ContactFrames>>();
  for (const std::string_view knowledge : kKnowledge) {
    for (const Way& way : kWays) {
      add_case(fmt::format("choice/{}/{}", knowledge, way.name),
               [&session, knowledge, way, frames] {
                 if (!*frames) frames->emplace(Indenters::mixed, kFrames);
                 return time_way(session, knowledge, way, **frames);
               });
    }
  }
}

}  // namespace pillarfield::bench
