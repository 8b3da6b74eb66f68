#include "contacts/contact_matching.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace pillarfield {
namespace {

/// Number of pillars that an earlier contact and a current one share.
struct Shared {
  std::uint32_t before = 0;
  std::uint32_t now = 0;
  std::uint64_t pillars = 0;
};

/// Adds the overlap of two runs to the last entry of the current contact, if its pair is equal.
void add_overlap(const Shared& overlap, std::vector<Shared>& found,
                 std::vector<std::size_t>& last) {
  const std::size_t place = last[overlap.now];
  if (place < found.size() && found[place].before == overlap.before) {
    found[place].pillars += overlap.pillars;
    return;
  }
  last[overlap.now] = found.size();
  found.push_back(overlap);
}

/// One or more entries per pair of contacts whose runs overlap.
std::vector<Shared> overlaps(std::span<const ContactRun> before, std::span<const ContactRun> now,
                             std::size_t contacts_now) {
  std::vector<Shared> found;
  std::vector<std::size_t> last(contacts_now, SIZE_MAX);
  std::size_t a = 0;
  std::size_t b = 0;
  while (a < before.size() && b < now.size()) {
    const ContactRun& earlier = before[a];
    const ContactRun& later = now[b];
    if (earlier.row == later.row) {
      const std::uint32_t first = std::max(earlier.first, later.first);
      const std::uint32_t end = std::min(earlier.end, later.end);
      const bool tracked = earlier.contact != kNoContact && later.contact != kNoContact;
      if (first < end && tracked) {
        add_overlap({earlier.contact, later.contact, end - first}, found, last);
      }
    }
    const bool earlier_ends = std::tie(earlier.row, earlier.end) < std::tie(later.row, later.end);
    ++(earlier_ends ? a : b);
  }
  return found;
}

/// One entry per pair of contacts that share pillars.
std::vector<Shared> shared_pillars(const ContactSnapshot& before, const ContactSnapshot& now) {
  std::vector<Shared> found = overlaps(before.runs, now.runs, now.centres.size());
  std::sort(found.begin(), found.end(), [](const Shared& a, const Shared& b) {
    return std::tie(a.before, a.now) < std::tie(b.before, b.now);
  });
  std::vector<Shared> pairs;
  for (const Shared& overlap : found) {
    if (!pairs.empty() && pairs.back().before == overlap.before &&
        pairs.back().now == overlap.now) {
      pairs.back().pillars += overlap.pillars;
    } else {
      pairs.push_back(overlap);
    }
  }
  return pairs;
}

/// An earlier contact within reach of a current one.
struct Near {
  std::uint32_t before = 0;
  std::uint32_t now = 0;
  double square_mm2 = 0;  ///< squared distance of their centres
};

/// Earlier contacts sorted into rows as high as the reach: all contacts within reach of a place lie
/// in three rows.
class Neighbourhood {
 public:
  Neighbourhood(const ContactSnapshot& before, std::span<const std::uint32_t> free, double reach_mm)
      : before_(before), reach_mm_(reach_mm), height_mm_(std::max(reach_mm, kLeastHeightMm)) {
    for (const std::uint32_t contact : free) {
      entries_.push_back({row_of(before.centres[contact].y_mm), before.centres[contact].x_mm,
                          before.track_ids[contact], contact});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Appends the kNearest nearest contacts within reach of `place`.
  void add_nearest(const PatchPlace& place, std::uint32_t now, std::vector<Near>& found) const {
    const std::size_t begin = found.size();
    for (const int step : {-1, 0, 1}) {
      const double row = row_of(place.y_mm) + step;
      const Entry left = {row, place.x_mm - reach_mm_, 0, 0};
      for (auto entry = std::lower_bound(entries_.begin(), entries_.end(), left);
           entry != entries_.end() && entry->row == row && entry->x_mm <= place.x_mm + reach_mm_;
           ++entry) {
        const double x = entry->x_mm - place.x_mm;
        const double y = before_.centres[entry->contact].y_mm - place.y_mm;
        const double square = x * x + y * y;
        if (square <= reach_mm_ * reach_mm_) found.push_back({entry->contact, now, square});
      }
    }
    keep_nearest(begin, found);
  }

  [[nodiscard]] bool before_each_other(const Near& a, const Near& b) const {
    return std::tie(a.square_mm2, before_.track_ids[a.before], a.now) <
           std::tie(b.square_mm2, before_.track_ids[b.before], b.now);
  }

 private:
  static constexpr std::size_t kNearest = 8;
  static constexpr double kLeastHeightMm = 1e-3;  // keeps row numbers exact

  struct Entry {
    double row = 0;
    double x_mm = 0;
    std::uint64_t track_id = 0;
    std::uint32_t contact = 0;
    bool operator<(const Entry& other) const {
      return std::tie(row, x_mm, track_id) < std::tie(other.row, other.x_mm, other.track_id);
    }
  };

  [[nodiscard]] double row_of(double y_mm) const { return std::floor(y_mm / height_mm_); }

  void keep_nearest(std::size_t begin, std::vector<Near>& found) const {
    if (found.size() - begin <= kNearest) return;
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(begin);
    std::partial_sort(first, first + kNearest, found.end(),
                      [this](const Near& a, const Near& b) { return before_each_other(a, b); });
    found.resize(begin + kNearest);
  }

  const ContactSnapshot& before_;
  double reach_mm_;
  double height_mm_;
  std::vector<Entry> entries_;
};

/// Contacts that are unmatched and share no pillar with a contact of the other frame.
std::vector<std::uint32_t> unmatched(const std::vector<std::uint32_t>& matched,
                                     const std::vector<std::uint32_t>& sharing) {
  std::vector<std::uint32_t> free;
  for (std::uint32_t contact = 0; contact < matched.size(); ++contact) {
    if (matched[contact] == kNoContact && sharing[contact] == kNoContact) free.push_back(contact);
  }
  return free;
}

/// A matching in progress.
struct Matching {
  ContactAssignment result;
  std::vector<std::uint32_t> later;  ///< of each earlier contact: the contact that continues it

  void match(std::uint32_t before, std::uint32_t now) {
    if (later[before] != kNoContact || result.earlier[now] != kNoContact) return;
    later[before] = now;
    result.earlier[now] = before;
  }
};

/// Matches by shared pillars, and records splits and merges of the unmatched contacts.
void match_by_pillars(const ContactSnapshot& before, const ContactSnapshot& now,
                      Matching& matching) {
  std::vector<Shared> pairs = shared_pillars(before, now);
  std::sort(pairs.begin(), pairs.end(), [&](const Shared& a, const Shared& b) {
    return std::tie(b.pillars, before.track_ids[a.before], a.now) <
           std::tie(a.pillars, before.track_ids[b.before], b.now);
  });
  for (const Shared& pair : pairs) matching.match(pair.before, pair.now);
  for (const Shared& pair : pairs) {
    std::uint32_t& parent = matching.result.parents[pair.now];
    std::uint32_t& merged = matching.result.merged[pair.before];
    if (matching.result.earlier[pair.now] == kNoContact && parent == kNoContact) {
      parent = pair.before;
    }
    if (matching.later[pair.before] == kNoContact && merged == kNoContact) merged = pair.now;
  }
}

void match_by_distance(const ContactSnapshot& before, const ContactSnapshot& now, double reach_mm,
                       Matching& matching) {
  if (!(reach_mm > 0)) return;
  const std::vector<std::uint32_t> lost = unmatched(matching.later, matching.result.merged);
  const std::vector<std::uint32_t> found =
      unmatched(matching.result.earlier, matching.result.parents);
  if (lost.empty() || found.empty()) return;
  const Neighbourhood neighbourhood(before, lost, reach_mm);
  std::vector<Near> pairs;
  for (const std::uint32_t contact : found) {
    neighbourhood.add_nearest(now.centres[contact], contact, pairs);
  }
  std::sort(pairs.begin(), pairs.end(),
            [&](const Near& a, const Near& b) { return neighbourhood.before_each_other(a, b); });
  for (const Near& pair : pairs) matching.match(pair.before, pair.now);
}

}  // namespace

ContactAssignment match_contacts(const ContactSnapshot& before, const ContactSnapshot& now,
                                 double reach_mm) {
  Matching matching;
  matching.later.assign(before.track_ids.size(), kNoContact);
  matching.result.merged.assign(before.track_ids.size(), kNoContact);
  matching.result.earlier.assign(now.centres.size(), kNoContact);
  matching.result.parents.assign(now.centres.size(), kNoContact);
  match_by_pillars(before, now, matching);
  match_by_distance(before, now, reach_mm, matching);
  return std::move(matching.result);
}

}  // namespace pillarfield
