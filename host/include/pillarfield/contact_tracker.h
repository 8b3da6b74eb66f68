#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/contact_map.h"
#include "pillarfield/contact_quantities.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// A contact of a frame and who it is.
struct TrackedContact {
  std::uint64_t id = 0;                 ///< 1, 2, ...; never given twice
  std::uint32_t number = 0;             ///< in the frame's ContactMap
  std::optional<std::uint64_t> parent;  ///< the contact that it split from, or unset
  double first_time_s = 0;              ///< of the first frame it was in
  double age_s = 0;                     ///< since then
  ContactQuantities quantities;
};

/// A contact of the frame before that is in this one no more.
struct EndedContact {
  std::uint64_t id = 0;
  std::optional<std::uint64_t> merged_into;  ///< unset where it left the skin
  double first_time_s = 0;
  double last_time_s = 0;  ///< of the last frame it was in
};

/// The contacts of a frame, in the order of their numbers.
struct FrameContacts {
  double time_s = 0;
  std::vector<TrackedContact> contacts;
  std::vector<EndedContact> ended;  ///< by id
  /// All loaded pillars of the patch together, those of contacts too small to be listed included.
  /// Its friction is what was given: bodies of unlike friction may be on the patch.
  ContactQuantities patch;
};

/// What contacts are looked for and how they are followed.
struct ContactOptions {
  std::uint64_t minimum_pillars = 1;  ///< smaller contacts are neither listed nor followed
  FrictionKnowledge friction = {};    ///< what is known of their friction before any reading
  /// Standard deviation of a reading over counts per newton, N, 0 to 1e6; unset: a sixty-fourth of
  /// the largest force of each contact.
  std::optional<double> noise_n = {};
  /// The normal force that sensels may hide at the threshold, N: half of it over counts per newton
  /// (hidden_normal_n()), 0 to 1e6.
  double hidden_n = 0;
  double reach_mm = 10;  ///< how far a contact may jump, 0 to 1000
  /// That measure a frame's contacts together, 0 to 1024; 0: as many as the processor has. What is
  /// found does not depend on it. They start with the first frame of more than 4000 loaded pillars
  /// and sleep between frames.
  std::uint32_t threads = 0;
};

/// Throws Error, its place being `where`, when a member is out of its range.
void check(const ContactOptions& options, const std::string& where);

/// Finds the contacts of frame after frame, what they exert, and which of them are the same.
///
/// Contacts of two frames are matched first by shared pillars: the pair that shares most first, of
/// equal pairs that of the lower id, then of the lower number; each contact once. Of those left
/// over, one that shares pillars with an earlier contact has split from it (from that with which it
/// shares most), and an earlier one that shares pillars with a contact has merged into it. Those
/// that share none are matched by the distance of their centres, up to reach_mm and the nearest
/// first, each with one of the eight nearest. What is then left is new or has ended. An id that has
/// ended does not return.
///
/// So a contact that splits lives on as its larger part, and of several that merge the one that
/// brought most pillars lives on.
class ContactTracker {
 public:
  /// Throws Error on options out of range.
  explicit ContactTracker(double pillar_pitch_mm, const ContactOptions& options = {});
  ~ContactTracker();
  ContactTracker(ContactTracker&&) noexcept;
  ContactTracker& operator=(ContactTracker&&) noexcept;

  /// Takes the next frame; the result stays until the next call. Time goes with the pillars of the
  /// patch for finding contacts and with loaded ones for the rest, n log n in contacts. Forces of
  /// any value are taken. Where the contacts of this frame were found already, `found` has them
  /// (Processor::contacts()); it is copied. Throws Error where planes are not of the field's size,
  /// that is not the size of the frame before, a run of `found` lies outside it, or it has
  /// frictions but not one for each contact.
  const FrameContacts& update(const ForceFieldView& forces, double time_s,
                              const FoundContacts& found = {});

  /// The pillars of the contacts of the frame last taken, small ones included.
  [[nodiscard]] const ContactMap& map() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
