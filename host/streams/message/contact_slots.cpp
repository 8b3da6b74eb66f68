#include "streams/message/contact_slots.h"

#include <algorithm>

namespace pillarfield {

const std::array<ContactSlots::Slot, ContactSlots::kSlots>& ContactSlots::update(
    const FrameContacts& contacts) {
  slots_ = {};
  const auto place_of = [&](std::uint64_t track) {
    return static_cast<std::size_t>(std::ranges::find(tracks_, track) - tracks_.begin());
  };
  for (const TrackedContact& contact : contacts.contacts) {
    const std::size_t place = place_of(contact.track_id);
    if (place < kSlots) slots_[place].contact = &contact;
  }
  for (std::size_t place = 0; place < kSlots; ++place) {
    slots_[place].ended = tracks_[place] != 0 && slots_[place].contact == nullptr;
    if (slots_[place].ended) tracks_[place] = 0;
  }
  for (const TrackedContact& contact : contacts.contacts) {
    if (place_of(contact.track_id) < kSlots) continue;
    const std::size_t place = place_of(0);
    if (place == kSlots) break;
    tracks_[place] = contact.track_id;
    slots_[place].contact = &contact;
  }
  return slots_;
}

}  // namespace pillarfield
