// Cost of the estimator `contact` and of tracking contacts, relative to the direct solve.

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "bench/cases/cases.h"
#include "bench/contact_frames.h"
#include "bench/timing/solve_timing.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/status.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFieldFrames = 16;  ///< 40 MB

/// Holds the frames of the last case, which are simulated on first use.
class ContactFrameStore {
 public:
  const ContactFrames& of(Indenters indenters) {
    if (!last_ || indenters != last_indenters_) {
      last_.reset();  // Before the next allocation.
      last_.emplace(indenters, kFieldFrames);
      last_indenters_ = indenters;
    }
    return *last_;
  }

 private:
  std::optional<ContactFrames> last_;
  Indenters last_indenters_ = Indenters::mixed;
};

ContactOptions contact_options(const SolverPlan& plan) {
  ContactOptions options;
  set_sensor(options, plan);
  return options;
}

struct Method {
  const char* name;
  Estimator estimator;
  bool contacts;  ///< tracked by a ContactTracker
};
constexpr Method kMethods[] = {{"direct", Estimator::direct, false},
                               {"direct_and_contacts", Estimator::direct, true},
                               {"contact", Estimator::contact, false},
                               {"contact_and_contacts", Estimator::contact, true}};

/// Counters: fraction of the pillars that are loaded, and of these, fraction in region 3 or 4.
void report_pillars(const ForceFieldView& forces, Measurement& measured) {
  double loaded = 0;
  double ambiguous = 0;
  for (const std::uint8_t bits : forces.status) {
    if ((bits & status::kUsable) == 0) continue;
    loaded += 1;
    const Region region = region_of(bits);
    if (region != Region::one && region != Region::two) ambiguous += 1;
  }
  measured.counters["contact"] = loaded / static_cast<double>(forces.status.size());
  measured.counters["ambiguous"] = ambiguous / loaded;
}

Measurement time_field(const Session& session, const Method& method,
                       const ContactFrames& contacts) {
  SolverPlan plan = contacts.plan();
  plan.estimator = method.estimator;
  const Frames& frames = contacts.frames();
  FrameSolver direct(session.solver, contacts.plan(), frames);
  FrameSolver solver(session.solver, plan, frames);
  ContactTracker tracker(plan.skin.pillar_pitch_mm(), contact_options(plan));
  if (method.contacts) solver.track(tracker);
  InterleavedTiming timing;
  const std::size_t direct_entry = timing.add([&](int count) { direct.run(count); });
  const std::size_t entry = timing.add([&](int count) { solver.run(count); });
  timing.run(session.length);
  Measurement measured = measurement_of(timing, entry, plan);
  measured.counters["over_direct"] = timing.ratio(entry, direct_entry);
  measured.counters["processor_over_direct"] = timing.processor_ratio(entry, direct_entry);
  report_pillars(direct.solve(frames[0]), measured);
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

}  // namespace

void add_field_cases(const Session& session) {
  const auto store = std::make_shared<ContactFrameStore>();
  for (const auto& [name, indenters] :
       {std::pair{"mixed", Indenters::mixed}, {"slipping", Indenters::slipping}}) {
    for (const Method& method : kMethods) {
      add_case(fmt::format("field/{}/{}", name, method.name),
               [&session, method, which = indenters, store] {
                 return time_field(session, method, store->of(which));
               });
    }
  }
}

}  // namespace pillarfield::bench
