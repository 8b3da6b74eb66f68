#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_tracker.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// The contacts of a shown field.
struct ShownContacts {
  FrameContacts found;
  std::vector<PillarRect> extents;    ///< bounding rectangles, in the order of `found.contacts`
  std::vector<std::size_t> heaviest;  ///< indices into `found.contacts`, by descending normal force
};

/// Adds the extents of contacts. `map` holds the labels of the field that `found` refers to. Throws
/// Error for a label that `map` lacks.
[[nodiscard]] ShownContacts with_extents(FrameContacts found, const ContactLabels& map);

/// Finds and tracks contacts over the shown fields. Frames may be skipped; an earlier frame
/// restarts tracking with ids from 1.
class FieldContacts {
 public:
  explicit FieldContacts(const Pitch& element_pitch_mm, ContactOptions options = {})
      : pitch_mm_(element_pitch_mm), options_(std::move(options)) {}

  /// See ContactTracker::update() for time.
  [[nodiscard]] ShownContacts contacts_of(const ShownField& field);

 private:
  Pitch pitch_mm_;
  ContactOptions options_;
  std::optional<ContactTracker> tracker_;
  std::uint64_t last_index_ = 0;
};

}  // namespace pillarfield::viewer
