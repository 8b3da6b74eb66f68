#include "viewer/app/trails.h"

#include <algorithm>

#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {

void Trails::add(const ShownField& field) {
  if (field.contacts == nullptr || field.time_s < last_s_) trails_.clear();
  last_s_ = field.time_s;
  if (field.contacts == nullptr) return;
  for (std::size_t i = 0; i < field.contacts->above_noise; ++i) {
    const TrackedContact& contact = field.contacts->found.contacts[field.contacts->heaviest[i]];
    const PatchPlace& centre = contact.quantities.centre_of_pressure;
    extend(contact.track_id, {field.time_s, centre.x_mm, centre.y_mm});
  }
  for (Trail& trail : trails_) {
    std::erase_if(trail.places,
                  [&](const Place& place) { return place.time_s < last_s_ - kSeconds; });
  }
  std::erase_if(trails_, [](const Trail& trail) { return trail.places.empty(); });
}

void Trails::extend(std::uint64_t track_id, const Place& place) {
  auto found = std::ranges::find(trails_, track_id, &Trail::track_id);
  if (found == trails_.end()) found = trails_.insert(trails_.end(), Trail{track_id, {}});
  if (!found->places.empty() && found->places.back().time_s >= place.time_s) return;
  found->places.push_back(place);
}

}  // namespace pillarfield::viewer
