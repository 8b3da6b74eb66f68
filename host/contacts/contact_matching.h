#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/contact_labels.h"
#include "pillarfield/contact_quantities.h"

namespace pillarfield {

/// Stands for no contact.
inline constexpr std::uint32_t kNoContact = UINT32_MAX;

/// What of a frame's contacts the next frame is compared with.
struct ContactTraces {
  /// Runs row by row; `contact` is an index into the two lists below, or kNoContact where the
  /// contact is not followed.
  std::vector<ContactRun> runs;
  std::vector<std::uint64_t> ids;
  std::vector<PatchPlace> centres;
};

/// Who is who, by index.
struct ContactMatches {
  std::vector<std::uint32_t> earlier;  ///< of each contact now, the same one before, or kNoContact
  std::vector<std::uint32_t> parents;  ///< of each contact now, the earlier one it split from
  std::vector<std::uint32_t> merged;   ///< of each earlier contact, that now which it went into
};

/// Matches the contacts of two frames as ContactTracker says. `now` needs no ids.
[[nodiscard]] ContactMatches match_contacts(const ContactTraces& before, const ContactTraces& now,
                                            double reach_mm);

}  // namespace pillarfield
