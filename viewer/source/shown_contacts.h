#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_tracker.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// The contacts of a field to look at.
struct ShownContacts {
  FrameContacts found;
  std::vector<PillarRect> extents;    ///< the pillars about each, in the order of `found.contacts`
  std::vector<std::size_t> heaviest;  ///< places in `found.contacts`, by normal force downwards
};

/// Adds where the contacts of a field lie. `map` is that of the field's status, whose numbers
/// `found` has. Throws Error where it lacks one of them.
[[nodiscard]] ShownContacts with_extents(FrameContacts found, const ContactLabels& map);

/// Finds the contacts of field after field, as they are shown: frames may be left out, and one that
/// comes before the last begins anew, with ids from 1.
class ContactWatch {
 public:
  explicit ContactWatch(double pillar_pitch_mm, const ContactOptions& options = {})
      : pitch_mm_(pillar_pitch_mm), options_(options) {}

  /// Time as ContactTracker::update().
  [[nodiscard]] ShownContacts contacts_of(const ShownField& field);

 private:
  double pitch_mm_;
  ContactOptions options_;
  std::optional<ContactTracker> tracker_;
  std::uint64_t last_index_ = 0;
};

}  // namespace pillarfield::viewer
