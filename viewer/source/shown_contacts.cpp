#include "viewer/source/shown_contacts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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

/// Force below which a single pillar is noise, N.
double noise_limit(const FrameContacts& found, std::optional<double> noise_n) {
  constexpr double kDeviations = 5;
  constexpr double kShareOfPeak = 0.02;
  return noise_n ? kDeviations * *noise_n : kShareOfPeak * found.total.peak_n;
}

bool is_at_noise(const ContactQuantities& contact, double limit_n) {
  return contact.pillars == 1 &&
         std::hypot(contact.shear_x_n, contact.shear_y_n, contact.normal_n) < limit_n;
}

}  // namespace

ShownContacts with_extents(FrameContacts found, const ContactLabels& map,
                           std::optional<double> noise_n) {
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
  const double limit_n = noise_limit(found, noise_n);
  const auto noise = std::stable_partition(
      shown.heaviest.begin(), shown.heaviest.end(),
      [&](std::size_t place) { return !is_at_noise(found.contacts[place].quantities, limit_n); });
  shown.above_noise = static_cast<std::size_t>(noise - shown.heaviest.begin());
  shown.found = std::move(found);
  return shown;
}

ShownContacts FieldContacts::contacts_of(const ShownField& field) {
  if (!tracker_ || field.index < last_index_) {
    tracker_.emplace(pitch_mm_, options_);
  }
  last_index_ = field.index;
  const FrameContacts& found = tracker_->update(field.forces, field.time_s);
  return with_extents(found, tracker_->labels(), options_.noise_n);
}

}  // namespace pillarfield::viewer
