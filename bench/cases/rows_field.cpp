// What the estimator `contact`, and following contacts, cost beside the direct solve.

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "bench/body_frames.h"
#include "bench/cases/rows.h"
#include "bench/timing/solve_race.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/status.h"

namespace pillarfield::bench {
namespace {

constexpr std::size_t kFrames = 16;  ///< 40 MB

/// Frames of bodies, made when the first row asks for them.
class BodyFrameStore {
 public:
  const BodyFrames& of(Bodies bodies) {
    if (!last_ || bodies != last_bodies_) {
      last_.reset();  // Before the next are made.
      last_.emplace(bodies, kFrames);
      last_bodies_ = bodies;
    }
    return *last_;
  }

 private:
  std::optional<BodyFrames> last_;
  Bodies last_bodies_ = Bodies::mixed;
};

/// A processor that works through frames, and a tracker that follows the contacts of its results
/// while the next frame is being solved.
class ContactFollower {
 public:
  ContactFollower(const Device& device, const SolverPlan& plan, const Frames& frames)
      : frames_(&frames),
        processor_(device, plan),
        tracker_(plan.skin.pillar_pitch_mm(), {.friction = plan.friction,
                                               .noise_n = reading_noise_n(plan),
                                               .hidden_n = hidden_normal_n(plan.skin)}) {}

  void run(int frames) {
    for (int i = 0; i < frames; ++i) {
      if (processor_.in_flight() == Processor::Options{}.frames_in_flight) receive();
      processor_.submit((*frames_)[submitted_++]);
    }
    while (processor_.in_flight() > 0) receive();
  }

 private:
  void receive() {
    const ForceFieldView forces = processor_.receive();
    tracker_.update(forces, static_cast<double>(received_++), processor_.contacts());
  }

  const Frames* frames_;
  Processor processor_;
  ContactTracker tracker_;
  std::size_t submitted_ = 0;
  std::size_t received_ = 0;
};

struct What {
  const char* name;
  Estimator estimator;
  bool contacts;  ///< followed by a ContactTracker
};
constexpr What kWhat[] = {{"direct", Estimator::direct, false},
                          {"direct_and_contacts", Estimator::direct, true},
                          {"contact", Estimator::contact, false},
                          {"contact_and_contacts", Estimator::contact, true}};

/// Shares of pillars: in contact, and of these of those that leave their force open.
void tell_pillars(const ForceFieldView& forces, Measurement& measured) {
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

Measurement race_field(const Session& session, const What& what, const BodyFrames& bodies) {
  SolverPlan plan = bodies.plan();
  plan.estimator = what.estimator;
  const Frames& frames = bodies.frames();
  FrameSolver direct(session.device, bodies.plan(), frames);
  FrameSolver solver(session.device, plan, frames);
  ContactFollower follower(session.device, plan, frames);
  Race race;
  const std::size_t direct_entry = race.add([&](int count) { direct.run(count); });
  const std::size_t entry = race.add([&](int count) {
    if (what.contacts) {
      follower.run(count);
    } else {
      solver.run(count);
    }
  });
  race.run(session.length);
  Measurement measured = measurement_of(race, entry, plan);
  measured.counters["over_direct"] = race.ratio(entry, direct_entry);
  measured.counters["processor_over_direct"] = race.processor_ratio(entry, direct_entry);
  tell_pillars(direct.solve(frames[0]), measured);
  measured.label = fmt::format("{} frames", frames.size());
  return measured;
}

}  // namespace

void add_field_rows(const Session& session) {
  const auto store = std::make_shared<BodyFrameStore>();
  for (const auto& [name, bodies] :
       {std::pair{"mixed", Bodies::mixed}, {"slipping", Bodies::slipping}}) {
    for (const What& what : kWhat) {
      add_row(fmt::format("field/{}/{}", name, what.name), [&session, what, which = bodies, store] {
        return race_field(session, what, store->of(which));
      });
    }
  }
}

}  // namespace pillarfield::bench
