#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// A contact of a frame, with its identity.
struct TrackedContact {
  std::uint64_t track_id = 0;           ///< 1, 2, ...; never reused
  std::uint32_t label = 0;              ///< in the frame's ContactLabels
  std::optional<std::uint64_t> parent;  ///< track_id of the contact it split from
  double first_time_s = 0;              ///< time of its first frame
  double age_s = 0;                     ///< time since then
  ContactQuantities quantities;
};

/// A contact of the previous frame that this frame no longer has.
struct EndedContact {
  std::uint64_t track_id = 0;
  std::optional<std::uint64_t> merged_into;  ///< unset if it left the skin
  double first_time_s = 0;
  double last_time_s = 0;  ///< time of its last frame
};

/// The contacts of a frame, by label.
struct FrameContacts {
  double time_s = 0;
  std::vector<TrackedContact> contacts;
  std::vector<EndedContact> ended;  ///< by track_id
  /// The total over all loaded pillars of the patch, contacts that are not listed included. Its
  /// friction is FrictionKnowledge::given, since contacts may differ in friction.
  ContactQuantities total;
};

/// Options of finding and tracking contacts.
struct ContactOptions {
  std::uint64_t minimum_pillars = 1;  ///< smaller contacts are neither listed nor tracked
  FrictionKnowledge friction = {};    ///< prior of their friction
  /// Standard deviation of a reading as a force, N, 0 to 1e6: reading_noise_n(). A contact of one
  /// pillar with a force below five of it is neither listed nor tracked. Unset: all are, and for
  /// the friction it is 1/64 of the largest force of each contact.
  std::optional<double> noise_n = {};
  /// Normal force that an inactive sensel may hide below the threshold, N, 0 to 1e6:
  /// hidden_normal_n().
  double hidden_n = 0;
  SensorEffects effects = {};  ///< of the skin; the shear coefficient and the arm matter
  /// Surface of the skin, for ContactQuantities::wrench; it must fit the pillars. Unset: no wrench.
  std::optional<Surface> surface = {};
  SkinLayout layout = SkinLayout::pillars;  ///< without pillars nothing is known of friction
  double reach_mm = 10;  ///< how far a contact may move between frames, 0 to 1000
  /// Threads that measure a frame's contacts, 0 to 1024; 0: one per hardware thread. The result
  /// does not depend on it. They start at the first frame of more than 4000 loaded pillars and
  /// sleep between frames.
  std::uint32_t threads = 0;
};

/// Sets the friction and the properties of the sensor to those of a plan.
void set_sensor(ContactOptions& options, const SolverPlan& plan);

/// Throws Error, naming `where`, if a member is out of range.
void check(const ContactOptions& options, const std::string& where);

/// Finds the contacts of each frame, measures them, and tracks them from frame to frame.
///
///     ContactTracker tracker(plan.skin.element_pitch_mm());
///     const FrameContacts& contacts = tracker.update(processor.receive(), time_s);
///
/// Matching, in order: (1) the pair of contacts that shares most pillars, each contact once; ties
/// go to the lower track_id, then the lower label. (2) An unmatched contact that shares pillars
/// with an earlier one has split from it; an unmatched earlier one that shares pillars with a
/// contact has merged into it. (3) The rest by distance of centres, nearest first, up to reach_mm,
/// among the eight nearest of each. What remains is new or has ended. The track_id of an ended
/// contact does not return.
///
/// Thus the larger part of a contact that splits keeps its track_id, as does the contact with most
/// pillars of those that merge.
class ContactTracker {
 public:
  /// Throws Error if the options are out of range.
  explicit ContactTracker(const Pitch& element_pitch_mm, const ContactOptions& options = {});
  ~ContactTracker();
  ContactTracker(ContactTracker&&) noexcept;
  ContactTracker& operator=(ContactTracker&&) noexcept;

  /// Processes the next frame; the result is valid until the next call. Pass Processor::contacts()
  /// as `found` to save finding the contacts again; it is copied. Cost: linear in the pillars of
  /// the patch for finding, in loaded pillars for measuring, n log n in contacts. Throws Error if
  /// planes differ from the field's size, the field from the previous frame's, a run of `found`
  /// lies outside the field, `found` has frictions but not one per contact, or the time of a frame
  /// with contacts is not finite.
  const FrameContacts& update(const ForceFieldView& forces, double time_s,
                              const FoundContacts& found = {});

  /// Takes the properties of the sensor of another plan, as set_sensor() does, for the next frames;
  /// contacts keep their track_id, and what was seen of their friction is forgotten.
  void set_sensor(const SolverPlan& plan);

  [[nodiscard]] const ContactOptions& options() const;

  /// The pillars of the contacts of the last frame, small contacts included.
  [[nodiscard]] const ContactLabels& labels() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
