#include "viewer/source/shown_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

PillarRect extent_of(std::span<const ContactRun> runs) {
  PillarRect extent{runs.front().row, runs.back().row + 1, runs.front().first, runs.front().end};
  for (const ContactRun& run : runs) {
    extent.col_begin = std::min(extent.col_begin, run.first);
    extent.col_end = std::max(extent.col_end, run.end);
  }
  return extent;
}

}  // namespace

ShownContacts with_extents(FrameContacts found, const ContactLabels& map) {
  ShownContacts shown;
  shown.extents.reserve(found.contacts.size());
  for (const TrackedContact& contact : found.contacts) {
    if (contact.label >= map.contacts()) {
      throw Error("contacts",
                  fmt::format("label {} is not one of the {} contacts of the status plane",
                              contact.label, map.contacts()),
                  "solve the recording again");
    }
    shown.extents.push_back(extent_of(map.runs(contact.label)));
  }
  shown.heaviest.resize(found.contacts.size());
  std::iota(shown.heaviest.begin(), shown.heaviest.end(), std::size_t{0});
  std::ranges::stable_sort(shown.heaviest, std::ranges::greater(), [&](std::size_t place) {
    return found.contacts[place].quantities.normal_n;
  });
  shown.found = std::move(found);
  return shown;
}

ShownContacts FieldContacts::contacts_of(const ShownField& field) {
  if (!tracker_ || field.index < last_index_) {
    tracker_.emplace(pitch_mm_, options_);
  }
  last_index_ = field.index;
  const FrameContacts& found = tracker_->update(field.forces, field.time_s);
  return with_extents(found, tracker_->labels());
}

}  // namespace pillarfield::viewer
