#include "pillarfield/contact_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact_identity.h"
#include "core/contact_measure.h"
#include "core/contact_survey.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr const char* kPlace = "ContactTracker";
constexpr double kMostFriction = 100;
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

void require_inside(const ContactMap& map, const ForceFieldView& forces) {
  for (const ContactRun& run : map.runs()) {
    if (run.row < forces.rows && run.end <= forces.cols) continue;
    throw Error(kPlace,
                fmt::format("contacts found in row {} up to column {} of {} x {} pillars", run.row,
                            run.end, forces.rows, forces.cols),
                "give the ContactMap of the same frame");
  }
}

ContactOptions checked(const ContactOptions& options) {
  check(options, kPlace);
  return options;
}

/// What is remembered of a contact.
struct Known {
  std::optional<std::uint64_t> parent;
  double first_time_s = 0;
  std::optional<double> friction;  ///< last shown
};

}  // namespace

void check(const ContactOptions& options, const std::string& where) {
  const auto& friction = options.friction;
  if (friction && !(*friction > 0 && *friction <= kMostFriction)) {
    throw Error(where, fmt::format("a friction of {}", *friction),
                fmt::format("it must be above 0 and at most {}", kMostFriction));
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
  const FrameContacts& follow(const ForceFieldView& forces, double time_s);
  void measure(const ContactMeasure& measure);
  void identify(double time_s);
  void judge_slip(const ContactMeasure& measure);

  double pitch_mm;
  ContactOptions options;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  bool any_frame = false;
  double last_time_s = 0;
  std::uint64_t next_id = 1;
  ContactMap map;
  FrameContacts frame;
  std::vector<Known> known;  // of frame.contacts
  ContactSurvey survey;
  std::span<const ShownContact> shown;  // the survey's, of the contacts of the map
  PressingSum patch_slip;               // where a friction was given
  std::vector<std::uint32_t> indices;   // of these, the place in frame.contacts, or kNoContact
  ContactTraces traces;
  ContactTraces traces_before;
};

ContactTracker::State::State(double pillar_pitch_mm, const ContactOptions& contact_options)
    : pitch_mm(pillar_pitch_mm), options(checked(contact_options)), survey(options.threads) {
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

/// Lists the contacts that are large enough and what they exert, and the patch.
void ContactTracker::State::measure(const ContactMeasure& measure) {
  shown = survey.measure(measure, map, options.friction);
  indices.clear();
  frame.contacts.clear();
  ContactSum patch;
  patch_slip = {};
  for (std::uint32_t number = 0; number < map.contacts(); ++number) {
    const ShownContact& each = shown[number];
    patch.add(each.totals.sum);
    patch_slip.add(each.totals.slip);
    indices.push_back(kNoContact);
    if (static_cast<std::uint64_t>(each.totals.sum.pillars) < options.minimum_pillars) continue;
    indices.back() = static_cast<std::uint32_t>(frame.contacts.size());
    TrackedContact contact;
    contact.number = number;
    contact.quantities = measure.quantities(each.totals.sum);
    frame.contacts.push_back(contact);
  }
  frame.patch = measure.quantities(patch);
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
      known.push_back({std::nullopt, time_s, std::nullopt});
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

/// Which friction goes for each contact, and what slips at it.
void ContactTracker::State::judge_slip(const ContactMeasure& measure) {
  std::vector<std::size_t> remembering;
  std::vector<AssumedFriction> assumed;
  for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
    TrackedContact& contact = frame.contacts[i];
    const ShownContact& now = shown[contact.number];
    if (now.friction) {
      const auto source = options.friction ? FrictionSource::given : FrictionSource::shown;
      set_slip(contact.quantities, *now.friction, source, now.totals.slip);
      known[i].friction = now.friction;
    } else if (const auto& before = known[i].friction) {
      remembering.push_back(i);
      assumed.push_back({contact.number, *before});
    }
  }
  const std::vector<PressingSum> slips = survey.slip(measure, map, assumed);
  for (std::size_t i = 0; i < slips.size(); ++i) {
    set_slip(frame.contacts[remembering[i]].quantities, assumed[i].friction,
             FrictionSource::remembered, slips[i]);
  }
  if (!options.friction || frame.patch.pillars == 0) return;
  set_slip(frame.patch, *options.friction, FrictionSource::given, patch_slip);
}

/// Takes a frame whose contacts are found.
const FrameContacts& ContactTracker::State::follow(const ForceFieldView& forces, double time_s) {
  const ContactMeasure contact_measure(forces, pitch_mm);
  frame.time_s = time_s;
  measure(contact_measure);
  identify(time_s);
  judge_slip(contact_measure);
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
                                            const ContactMap* found) {
  state_->require_size(forces);
  if (found != nullptr) {
    require_inside(*found, forces);
    state_->map = *found;
  } else {
    state_->map.find(forces.status, forces.rows, forces.cols);
  }
  return state_->follow(forces, time_s);
}

const ContactMap& ContactTracker::map() const { return state_->map; }

}  // namespace pillarfield
