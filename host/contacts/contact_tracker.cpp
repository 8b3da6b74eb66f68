#include "pillarfield/contact_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contacts/contact_matching.h"
#include "contacts/contact_measure.h"
#include "contacts/contact_survey.h"
#include "contacts/estimator/friction_estimator.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr const char* kPlace = "ContactTracker";
constexpr double kMostNoiseN = 1e6;
constexpr double kMostReachMm = 1000;
constexpr std::uint32_t kMostThreads = 1024;

void require_whole(const ForceFieldView& forces) {
  const std::size_t pillars = std::size_t{forces.rows} * forces.cols;
  for (const std::span<const float> plane : {forces.shear_x, forces.shear_y, forces.normal}) {
    if (plane.size() == pillars) continue;
    throw Error(kPlace,
                fmt::format("a plane of {} forces for {} x {} pillars", plane.size(), forces.rows,
                            forces.cols),
                "give one for each pillar");
  }
}

void require_inside(const FoundContacts& found, const ForceFieldView& forces) {
  const ContactLabels& map = *found.map;
  if (!found.friction.empty() && found.friction.size() != map.contacts()) {
    throw Error(kPlace,
                fmt::format("{} frictions for {} contacts", found.friction.size(), map.contacts()),
                "give one for each, or none");
  }
  for (const ContactRun& run : map.runs()) {
    if (run.row < forces.rows && run.end <= forces.cols) continue;
    throw Error(kPlace,
                fmt::format("contacts found in row {} up to column {} of {} x {} pillars", run.row,
                            run.end, forces.rows, forces.cols),
                "give the ContactLabels of the same frame");
  }
}

ContactOptions checked(const ContactOptions& options) {
  check(options, kPlace);
  return options;
}

FrictionEstimator::Sensor sensor_of(double pitch_mm, const ContactOptions& options) {
  return {.pitch_mm = pitch_mm,
          .reach_mm = options.reach_mm,
          .noise_n = options.noise_n,
          .segment_end = {.hidden_n = static_cast<float>(options.hidden_n)}};
}

/// What identifies a contact from frame to frame, besides its id.
struct Known {
  std::optional<std::uint64_t> parent;
  double first_time_s = 0;
};

}  // namespace

void check(const ContactOptions& options, const std::string& where) {
  check(options.friction, where);
  if (options.noise_n && !(*options.noise_n >= 0 && *options.noise_n <= kMostNoiseN)) {
    throw Error(where, fmt::format("a noise of {} N", *options.noise_n),
                fmt::format("it must be 0 to {}", kMostNoiseN));
  }
  if (!(options.hidden_n >= 0 && options.hidden_n <= kMostNoiseN)) {
    throw Error(where, fmt::format("a hidden normal force of {} N", options.hidden_n),
                fmt::format("it must be 0 to {}", kMostNoiseN));
  }
  if (!(options.reach_mm >= 0 && options.reach_mm <= kMostReachMm)) {
    throw Error(where, fmt::format("contacts that jump by {} mm", options.reach_mm),
                fmt::format("it must be 0 to {}", kMostReachMm));
  }
  if (options.threads > kMostThreads) {
    throw Error(where, fmt::format("{} threads", options.threads),
                fmt::format("it must be 0 to {}", kMostThreads));
  }
}

struct ContactTracker::State {
  State(double pillar_pitch_mm, const ContactOptions& contact_options);

  void require_size(const ForceFieldView& forces);
  const FrameContacts& follow(const ForceFieldView& forces, double time_s,
                              std::span<const ContactFriction> friction);
  void measure(const ForceFieldView& forces, std::span<const ContactFriction> friction);
  void identify(double time_s);

  double pitch_mm;
  ContactOptions options;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  bool any_frame = false;
  double last_time_s = 0;
  std::uint64_t next_id = 1;
  ContactLabels map;
  FrameContacts frame;
  std::vector<Known> known;  // of frame.contacts
  ContactSurvey survey;
  FrictionEstimator friction_estimator;
  std::vector<std::uint32_t> indices;  // of the map's contacts, the place in frame.contacts
  ContactTraces traces;
  ContactTraces traces_before;
};

ContactTracker::State::State(double pillar_pitch_mm, const ContactOptions& contact_options)
    : pitch_mm(pillar_pitch_mm),
      options(checked(contact_options)),
      survey(options.threads),
      friction_estimator(sensor_of(pitch_mm, options), options.friction, survey.threads()) {
  if (!std::isfinite(pitch_mm) || pitch_mm <= 0) {
    throw Error(kPlace, fmt::format("a pillar pitch of {} mm", pitch_mm), "it must be above zero");
  }
}

void ContactTracker::State::require_size(const ForceFieldView& forces) {
  require_whole(forces);
  if (any_frame && (forces.rows != rows || forces.cols != cols)) {
    throw Error(kPlace,
                fmt::format("a frame of {} x {} pillars after such of {} x {}", forces.rows,
                            forces.cols, rows, cols),
                "follow them with another tracker");
  }
  rows = forces.rows;
  cols = forces.cols;
}

/// Lists the contacts that are large enough and what they exert, and the patch. Their friction is
/// learnt where none is given.
void ContactTracker::State::measure(const ForceFieldView& forces,
                                    std::span<const ContactFriction> friction) {
  const bool learns = friction.empty() && map.contacts() > 0;
  if (learns) {
    friction_estimator.begin(map);
    friction = friction_estimator.friction();
  }
  const auto friction_of = [&](std::uint32_t contact, std::size_t member) {
    if (learns) friction_estimator.learn(forces, map, contact, member);
    return known_friction(friction[contact]);
  };
  const std::vector<ContactSum>& sums = survey.measure(forces, map, friction_of);
  indices.clear();
  frame.contacts.clear();
  ContactSum patch;
  for (std::uint32_t number = 0; number < map.contacts(); ++number) {
    const ContactSum& sum = sums[number];
    patch.add(sum);
    indices.push_back(kNoContact);
    if (static_cast<std::uint64_t>(sum.pillars) < options.minimum_pillars) continue;
    indices.back() = static_cast<std::uint32_t>(frame.contacts.size());
    TrackedContact contact;
    contact.number = number;
    contact.quantities = quantities_of(sum, pitch_mm);
    set_slip(contact.quantities, friction[number], sum);
    frame.contacts.push_back(contact);
  }
  frame.patch = quantities_of(patch, pitch_mm);
  if (!options.friction.given || frame.patch.pillars == 0) return;
  set_slip(frame.patch, {*options.friction.given, kGivenFrictionSpread, FrictionSource::given},
           patch);
}

/// Gives each contact of the frame its id, and tells which of the frame before have ended.
void ContactTracker::State::identify(double time_s) {
  std::swap(traces, traces_before);
  traces.runs.assign(map.runs_by_row().begin(), map.runs_by_row().end());
  for (ContactRun& run : traces.runs) run.contact = indices[run.contact];
  traces.ids.clear();
  traces.centres.clear();
  for (const TrackedContact& contact : frame.contacts) {
    traces.centres.push_back(contact.quantities.centre);
  }
  const ContactMatches matches = match_contacts(traces_before, traces, options.reach_mm);

  std::vector<bool> lives(traces_before.ids.size());
  const std::vector<Known> known_before = std::exchange(known, {});
  for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
    TrackedContact& contact = frame.contacts[i];
    const std::uint32_t earlier = matches.earlier[i];
    if (earlier != kNoContact) {
      lives[earlier] = true;
      contact.id = traces_before.ids[earlier];
      known.push_back(known_before[earlier]);
    } else {
      contact.id = next_id++;
      const std::uint32_t parent = matches.parents[i];
      known.push_back({std::nullopt, time_s});
      if (parent != kNoContact) known.back().parent = traces_before.ids[parent];
    }
    contact.parent = known.back().parent;
    contact.first_time_s = known.back().first_time_s;
    contact.age_s = time_s - contact.first_time_s;
    traces.ids.push_back(contact.id);
  }

  frame.ended.clear();
  for (std::size_t i = 0; i < lives.size(); ++i) {
    if (lives[i]) continue;
    const std::uint32_t merged = matches.merged[i];
    EndedContact ended = {traces_before.ids[i], {}, known_before[i].first_time_s, last_time_s};
    if (merged != kNoContact) ended.merged_into = traces.ids[merged];
    frame.ended.push_back(ended);
  }
  std::sort(frame.ended.begin(), frame.ended.end(),
            [](const EndedContact& a, const EndedContact& b) { return a.id < b.id; });
}

/// Takes a frame whose contacts are found.
const FrameContacts& ContactTracker::State::follow(const ForceFieldView& forces, double time_s,
                                                   std::span<const ContactFriction> friction) {
  frame.time_s = time_s;
  measure(forces, friction);
  identify(time_s);
  any_frame = true;
  last_time_s = time_s;
  return frame;
}

ContactTracker::ContactTracker(double pillar_pitch_mm, const ContactOptions& options)
    : state_(std::make_unique<State>(pillar_pitch_mm, options)) {}
ContactTracker::~ContactTracker() = default;
ContactTracker::ContactTracker(ContactTracker&&) noexcept = default;
ContactTracker& ContactTracker::operator=(ContactTracker&&) noexcept = default;

const FrameContacts& ContactTracker::update(const ForceFieldView& forces, double time_s,
                                            const FoundContacts& found) {
  state_->require_size(forces);
  if (found.map != nullptr) {
    require_inside(found, forces);
    state_->map = *found.map;
    return state_->follow(forces, time_s, found.friction);
  }
  state_->map.find(forces.status, forces.rows, forces.cols);
  return state_->follow(forces, time_s, {});
}

const ContactLabels& ContactTracker::map() const { return state_->map; }

}  // namespace pillarfield
