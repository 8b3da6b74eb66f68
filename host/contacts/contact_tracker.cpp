#include "pillarfield/contact_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "contacts/contact_matching.h"
#include "contacts/contact_measure.h"
#include "contacts/estimator/friction_estimator.h"
#include "contacts/parallel_contact_moments.h"
#include "contacts/slip_trend.h"
#include "contacts/unseen_elements.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/error.h"
#include "pillarfield/force_field.h"
#include "pillarfield/surface.h"
#include "skin/limits.h"
#include "skin/vectors.h"
#include "solve/idle_blocks.h"

namespace pillarfield {
namespace {

/// Adds a wrench about the same point.
void add(Wrench& sum, const Wrench& wrench) {
  sum.force_n = sum.force_n + wrench.force_n;
  sum.moment_nmm = sum.moment_nmm + wrench.moment_nmm;
}

/// Force and moment of the pillars of runs, summed in their order. `poses` has one pose a pillar of
/// the field. NaN and infinite forces count as zero.
Wrench wrench_of(const ForceFieldView& forces, std::span<const ContactRun> runs,
                 std::span<const Pose> poses) {
  Wrench wrench;
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::size_t pillar = std::size_t{run.row} * forces.cols + col;
      const Pose& pose = poses[pillar];
      const auto of = [&](std::span<const float> plane) {
        return plane.empty() ? 0 : finite_or_zero(plane[pillar]);
      };
      const Vector3 force_n =
          rotated(pose, {of(forces.shear_x), of(forces.shear_y), -of(forces.normal)});
      add(wrench, {force_n, cross(pose.position_mm, force_n)});
    }
  }
  return wrench;
}

constexpr const char* kPlace = "ContactTracker";
constexpr double kMostNoiseN = 1e6;
constexpr std::uint32_t kMostThreads = 1024;

void require_planes(const ForceFieldView& forces, SkinLayout layout) {
  const std::size_t elements = std::size_t{forces.rows} * forces.cols;
  const std::size_t shears = layout == SkinLayout::pillars ? elements : 0;
  const auto require = [&](std::span<const float> plane, std::size_t values) {
    if (plane.size() == values) return;
    throw Error(kPlace,
                fmt::format("a plane of {} forces for {} x {} {}", plane.size(), forces.rows,
                            forces.cols, name_of(layout)),
                values == 0 ? "give normal forces alone" : "give one for each");
  };
  require(forces.shear_x, shears);
  require(forces.shear_y, shears);
  require(forces.normal, elements);
}

void require_valid(const FoundContacts& found, const ForceFieldView& forces) {
  const ContactLabels& labels = *found.labels;
  if (!found.friction.empty() && found.friction.size() != labels.contacts()) {
    throw Error(kPlace,
                fmt::format("{} friction coefficients for {} contacts", found.friction.size(),
                            labels.contacts()),
                "give one for each, or none");
  }
  for (const ContactRun& run : labels.runs()) {
    if (run.row < forces.rows && run.end <= forces.cols) continue;
    throw Error(kPlace,
                fmt::format("a contact in row {} up to column {} of {} x {} pillars", run.row,
                            run.end, forces.rows, forces.cols),
                "give the ContactLabels of the same frame");
  }
}

ContactOptions checked(const ContactOptions& options) {
  check(options, kPlace);
  return options;
}

FrictionEstimator::Sensor sensor_of(const Pitch& pitch_mm, const ContactOptions& options) {
  SegmentModel segment = segment_model(options.effects, pitch_mm.col_mm);
  segment.hidden_n = static_cast<float>(options.hidden_n);
  return {.pitch_mm = pitch_mm.col_mm,  // of pillars, whose pitch is one
          .reach_mm = options.reach_mm,
          .noise_n = options.noise_n,
          .segment = segment};
}

/// State of a tracked contact besides its track_id.
struct Track {
  std::optional<std::uint64_t> parent;
  double first_time_s = 0;
  SlipTrend trend = {};
};

/// Adds a frame to the trend of a contact, and sets its forecast: now, where it slides or spins.
void set_forecast(ContactQuantities& contact, double time_s, SlipTrend& trend) {
  if (!(contact.normal_n > 0)) return;
  trend.add(time_s, std::hypot(contact.shear_x_n, contact.shear_y_n) / contact.normal_n);
  if (contact.slip == SlipState::sliding) {
    contact.slip_forecast = {.time_s = 0, .low_s = 0, .high_s = 0, .probability = {1, 1, 1}};
  } else if (contact.friction_deviation) {
    contact.slip_forecast = trend.forecast(*contact.friction, *contact.friction_deviation);
  }
}

/// True for a contact of one pillar whose force is below five deviations of a reading.
bool is_noise(const ContactSum& sum, double noise_n) {
  constexpr double kDeviations = 5;
  return sum.pillars == 1 &&
         std::hypot(sum.shear_x, sum.shear_y, sum.normal) < kDeviations * noise_n;
}

}  // namespace

void set_sensor(ContactOptions& options, const SolverPlan& plan) {
  options.friction = plan.friction;
  options.noise_n = reading_noise_n(plan);
  options.hidden_n = hidden_normal_n(plan.skin);
  options.effects = plan.calibration.effects;
  options.surface = plan.skin.surface;
  options.layout = plan.skin.layout;
}

void check(const ContactOptions& options, const std::string& where) {
  check(options.friction, where);
  check(options.effects, where);
  if (options.noise_n && !(*options.noise_n >= 0 && *options.noise_n <= kMostNoiseN)) {
    throw Error(where, fmt::format("a noise of {} N", *options.noise_n),
                fmt::format("it must be 0 to {}", kMostNoiseN));
  }
  if (!(options.hidden_n >= 0 && options.hidden_n <= kMostNoiseN)) {
    throw Error(where, fmt::format("a hidden normal force of {} N", options.hidden_n),
                fmt::format("it must be 0 to {}", kMostNoiseN));
  }
  if (!kReachMm.contains(options.reach_mm)) {
    throw Error(where, fmt::format("a reach of {} mm", options.reach_mm),
                "it must be " + kReachMm.text());
  }
  if (options.threads > kMostThreads) {
    throw Error(where, fmt::format("{} threads", options.threads),
                fmt::format("it must be 0 to {}", kMostThreads));
  }
}

struct ContactTracker::State {
  State(const Pitch& element_pitch_mm, const ContactOptions& contact_options);

  [[nodiscard]] FrictionEstimator estimator() const {
    return {sensor_of(pitch_mm, options),
            options.friction,
            moments.threads(),
            {.past_pressure = false}};
  }
  void require_size(const ForceFieldView& forces);
  const FrameContacts& track(const ForceFieldView& forces, double time_s,
                             std::span<const ContactFriction> friction);
  void measure(const ForceFieldView& forces, std::span<const ContactFriction> friction);
  void measure_wrenches(const ForceFieldView& forces);
  void identify(double time_s);

  Pitch pitch_mm;
  ContactOptions options;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  bool any_frame = false;
  double last_time_s = 0;
  std::uint64_t next_track_id = 1;
  std::vector<Pose> poses;  // of the pillars, if options.surface is set
  ContactLabels labels;
  FrameContacts frame;
  std::vector<Track> tracks;  // of frame.contacts
  ParallelContactMoments moments;
  FrictionEstimator friction_estimator;
  std::vector<std::uint32_t> indices;  // in frame.contacts, by label
  ContactSnapshot snapshot;
  ContactSnapshot earlier_snapshot;
};

ContactTracker::State::State(const Pitch& element_pitch_mm, const ContactOptions& contact_options)
    : pitch_mm(element_pitch_mm),
      options(checked(contact_options)),
      moments(options.threads),
      friction_estimator(estimator()) {
  if (!pitch_mm.is_positive()) {
    throw Error(kPlace, fmt::format("a pitch of {} mm", text_of(pitch_mm)),
                "it must be above zero");
  }
}

void ContactTracker::State::require_size(const ForceFieldView& forces) {
  require_planes(forces, options.layout);
  if (any_frame && (forces.rows != rows || forces.cols != cols)) {
    throw Error(kPlace,
                fmt::format("a frame of {} x {} pillars after frames of {} x {}", forces.rows,
                            forces.cols, rows, cols),
                "use one tracker per field size");
  }
  rows = forces.rows;
  cols = forces.cols;
  if (any_frame || !options.surface) return;
  const ElementGrid pillars = {rows, cols, pitch_mm};
  check(*options.surface, pillars, kPlace);
  poses = poses_of(*options.surface, pillars);
}

/// Sets the wrench of each contact and of the total.
void ContactTracker::State::measure_wrenches(const ForceFieldView& forces) {
  Wrench total;
  for (std::uint32_t label = 0; label < labels.contacts(); ++label) {
    const Wrench wrench = wrench_of(forces, labels.runs(label), poses);
    add(total, wrench);
    if (indices[label] != kNoContact) frame.contacts[indices[label]].quantities.wrench = wrench;
  }
  frame.total.wrench = total;
}

/// Measures the total and the contacts that are listed. Estimates the friction of each contact,
/// unless `friction` holds it.
void ContactTracker::State::measure(const ForceFieldView& forces,
                                    std::span<const ContactFriction> friction) {
  const bool has_shear = options.layout == SkinLayout::pillars;
  const bool estimates = has_shear && friction.empty() && labels.contacts() > 0;
  if (estimates) {
    friction_estimator.begin(forces, labels);
    friction = friction_estimator.friction();
  }
  const double noise_n = options.noise_n.value_or(0);
  const auto test_of = [&](std::uint32_t contact, std::size_t member) {
    if (estimates) friction_estimator.update(forces, labels, contact, member);
    if (!has_shear) return std::optional<SlipTest>();
    return std::optional(slip_test(friction[contact], noise_n));
  };
  const std::vector<ContactSum>& sums = moments.measure(forces, labels, test_of);
  indices.clear();
  frame.contacts.clear();
  ContactSum total;
  std::vector<UnseenElements> all_unseen;
  for (std::uint32_t label = 0; label < labels.contacts(); ++label) {
    const ContactSum& sum = sums[label];
    total.add(sum);
    const std::vector<UnseenElements> unseen = unseen_elements(forces, labels.runs(label));
    all_unseen.insert(all_unseen.end(), unseen.begin(), unseen.end());
    indices.push_back(kNoContact);
    if (static_cast<std::uint64_t>(sum.pillars) < options.minimum_pillars) continue;
    if (is_noise(sum, noise_n)) continue;
    indices.back() = static_cast<std::uint32_t>(frame.contacts.size());
    TrackedContact contact;
    contact.label = label;
    contact.quantities = quantities_of(sum, unseen, pitch_mm, has_shear);
    if (has_shear) set_slip(contact.quantities, friction[label], sum);
    frame.contacts.push_back(contact);
  }
  frame.total = quantities_of(total, all_unseen, pitch_mm, has_shear);
  if (options.surface) measure_wrenches(forces);
  if (!has_shear || !options.friction.given || frame.total.pillars == 0) return;
  set_slip(frame.total, {*options.friction.given, kGivenFrictionSpread, FrictionSource::given},
           total);
}

/// Assigns a track_id to each contact of the frame and lists the contacts that have ended.
void ContactTracker::State::identify(double time_s) {
  std::swap(snapshot, earlier_snapshot);
  snapshot.runs.assign(labels.runs_by_row().begin(), labels.runs_by_row().end());
  for (ContactRun& run : snapshot.runs) run.contact = indices[run.contact];
  snapshot.track_ids.clear();
  snapshot.centres.clear();
  for (const TrackedContact& contact : frame.contacts) {
    snapshot.centres.push_back(contact.quantities.centre);
  }
  const ContactAssignment assignment = match_contacts(earlier_snapshot, snapshot, options.reach_mm);

  std::vector<bool> lives(earlier_snapshot.track_ids.size());
  const std::vector<Track> earlier_tracks = std::exchange(tracks, {});
  for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
    TrackedContact& contact = frame.contacts[i];
    const std::uint32_t earlier = assignment.earlier[i];
    if (earlier != kNoContact) {
      lives[earlier] = true;
      contact.track_id = earlier_snapshot.track_ids[earlier];
      tracks.push_back(earlier_tracks[earlier]);
    } else {
      contact.track_id = next_track_id++;
      const std::uint32_t parent = assignment.parents[i];
      tracks.push_back({std::nullopt, time_s, {}});
      if (parent != kNoContact) tracks.back().parent = earlier_snapshot.track_ids[parent];
    }
    contact.parent = tracks.back().parent;
    contact.first_time_s = tracks.back().first_time_s;
    contact.age_s = time_s - contact.first_time_s;
    set_forecast(contact.quantities, time_s, tracks.back().trend);
    snapshot.track_ids.push_back(contact.track_id);
  }

  frame.ended.clear();
  for (std::size_t i = 0; i < lives.size(); ++i) {
    if (lives[i]) continue;
    const std::uint32_t merged = assignment.merged[i];
    EndedContact ended = {
        earlier_snapshot.track_ids[i], {}, earlier_tracks[i].first_time_s, last_time_s};
    if (merged != kNoContact) ended.merged_into = snapshot.track_ids[merged];
    frame.ended.push_back(ended);
  }
  std::sort(frame.ended.begin(), frame.ended.end(),
            [](const EndedContact& a, const EndedContact& b) { return a.track_id < b.track_id; });
}

/// Processes a frame whose labels are set.
const FrameContacts& ContactTracker::State::track(const ForceFieldView& forces, double time_s,
                                                  std::span<const ContactFriction> friction) {
  if (!std::isfinite(time_s) && labels.contacts() > 0) {
    throw Error(kPlace, fmt::format("a frame with contacts has the time {}", time_s),
                "give finite seconds");
  }
  frame.time_s = time_s;
  measure(forces, friction);
  identify(time_s);
  any_frame = true;
  last_time_s = time_s;
  return frame;
}

ContactTracker::ContactTracker(const Pitch& element_pitch_mm, const ContactOptions& options)
    : state_(std::make_unique<State>(element_pitch_mm, options)) {}
ContactTracker::~ContactTracker() = default;
ContactTracker::ContactTracker(ContactTracker&&) noexcept = default;
ContactTracker& ContactTracker::operator=(ContactTracker&&) noexcept = default;

const FrameContacts& ContactTracker::update(const ForceFieldView& forces, double time_s,
                                            const FoundContacts& found) {
  state_->require_size(forces);
  if (found.labels != nullptr) {
    require_valid(found, forces);
    state_->labels = *found.labels;
    return state_->track(forces, time_s, found.friction);
  }
  const IdleBlocks idle = found.idle != nullptr ? *found.idle : IdleBlocks{};
  state_->labels.find(forces.status, forces.rows, forces.cols, idle);
  return state_->track(forces, time_s, {});
}

void ContactTracker::set_sensor(const SolverPlan& plan) {
  State& state = *state_;
  pillarfield::set_sensor(state.options, plan);
  state.friction_estimator = state.estimator();
}

const ContactOptions& ContactTracker::options() const { return state_->options; }

const ContactLabels& ContactTracker::labels() const { return state_->labels; }

}  // namespace pillarfield
