#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// Index that names no contact.
inline constexpr std::uint32_t kNoContact = UINT32_MAX;

/// The contacts of one frame, as matching between frames compares them.
struct ContactSnapshot {
  /// Runs row by row; `contact` is an index into the two lists below, or kNoContact for a contact
  /// that is not tracked.
  std::vector<ContactRun> runs;
  std::vector<std::uint64_t> track_ids;
  std::vector<PatchPlace> centres;
};

/// Assignment of the contacts of two frames, by index; kNoContact where there is none.
struct ContactAssignment {
  std::vector<std::uint32_t> earlier;  ///< of each contact now: the earlier contact it continues
  std::vector<std::uint32_t> parents;  ///< of each contact now: the earlier contact it split from
  std::vector<std::uint32_t> merged;   ///< of each earlier contact: the contact it merged into
};

/// Matches the contacts of two frames by the rules of ContactTracker. `now` needs no track_ids.
[[nodiscard]] ContactAssignment match_contacts(const ContactSnapshot& before,
                                               const ContactSnapshot& now, double reach_mm);

}  // namespace pillarfield
