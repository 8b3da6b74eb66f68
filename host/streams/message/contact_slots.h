#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pillarfield/contact_tracker.h"

namespace pillarfield {

/// Numbered places of contacts. A contact keeps its place while it lives; a new one takes the
/// lowest free place. Contacts beyond the last place have none.
class ContactSlots {
 public:
  static constexpr std::size_t kSlots = 16;

  struct Slot {
    const TrackedContact* contact = nullptr;  ///< null: free
    bool ended = false;                       ///< its contact ended with this frame
  };

  /// The places in this frame; the contacts must outlive their use.
  const std::array<Slot, kSlots>& update(const FrameContacts& contacts);

 private:
  std::array<std::uint64_t, kSlots> tracks_ = {};  // track_id; 0: free
  std::array<Slot, kSlots> slots_;
};

}  // namespace pillarfield
