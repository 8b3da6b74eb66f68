#include "contacts/contact_matching.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace pillarfield {
namespace {

/// Pillars that an earlier contact and one of now have in common.
struct Shared {
  std::uint32_t before = 0;
  std::uint32_t now = 0;
  std::uint64_t pillars = 0;
};

/// Adds a meeting of two runs to the last entry of the later contact, if that is of the same two.
void add_meeting(const Shared& meeting, std::vector<Shared>& found,
                 std::vector<std::size_t>& last) {
  const std::size_t place = last[meeting.now];
  if (place < found.size() && found[place].before == meeting.before) {
    found[place].pillars += meeting.pillars;
    return;
  }
  last[meeting.now] = found.size();
  found.push_back(meeting);
}

/// One entry or more for each two contacts whose runs meet.
std::vector<Shared> meetings(std::span<const ContactRun> before, std::span<const ContactRun> now,
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
      const bool followed = earlier.contact != kNoContact && later.contact != kNoContact;
      if (first < end && followed) {
        add_meeting({earlier.contact, later.contact, end - first}, found, last);
      }
    }
    const bool earlier_ends = std::tie(earlier.row, earlier.end) < std::tie(later.row, later.end);
    ++(earlier_ends ? a : b);
  }
  return found;
}

/// One entry for each two contacts that share pillars.
std::vector<Shared> shared_pillars(const ContactTraces& before, const ContactTraces& now) {
  std::vector<Shared> found = meetings(before.runs, now.runs, now.centres.size());
  std::sort(found.begin(), found.end(), [](const Shared& a, const Shared& b) {
    return std::tie(a.before, a.now) < std::tie(b.before, b.now);
  });
  std::vector<Shared> pairs;
  for (const Shared& meeting : found) {
    if (!pairs.empty() && pairs.back().before == meeting.before &&
        pairs.back().now == meeting.now) {
      pairs.back().pillars += meeting.pillars;
    } else {
      pairs.push_back(meeting);
    }
  }
  return pairs;
}

/// An earlier contact near one of now.
struct Near {
  std::uint32_t before = 0;
  std::uint32_t now = 0;
  double square_mm2 = 0;  ///< of the distance
};

/// Earlier contacts in rows as high as the reach, so that those within reach of a place lie in
/// three of them.
class Neighbourhood {
 public:
  Neighbourhood(const ContactTraces& before, std::span<const std::uint32_t> free, double reach_mm)
      : before_(before), reach_mm_(reach_mm), height_mm_(std::max(reach_mm, kLeastHeightMm)) {
    for (const std::uint32_t contact : free) {
      entries_.push_back({row_of(before.centres[contact].y_mm), before.centres[contact].x_mm,
                          before.ids[contact], contact});
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Appends the nearest ones within reach of `place`, kNearest at most.
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
    return std::tie(a.square_mm2, before_.ids[a.before], a.now) <
           std::tie(b.square_mm2, before_.ids[b.before], b.now);
  }

 private:
  static constexpr std::size_t kNearest = 8;
  static constexpr double kLeastHeightMm = 1e-3;  // keeps the rows' numbers exact

  struct Entry {
    double row = 0;
    double x_mm = 0;
    std::uint64_t id = 0;
    std::uint32_t contact = 0;
    bool operator<(const Entry& other) const {
      return std::tie(row, x_mm, id) < std::tie(other.row, other.x_mm, other.id);
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

  const ContactTraces& before_;
  double reach_mm_;
  double height_mm_;
  std::vector<Entry> entries_;
};

/// Those that no index in `taken` names and that share no pillar with anything.
std::vector<std::uint32_t> free_ones(const std::vector<std::uint32_t>& taken,
                                     const std::vector<std::uint32_t>& sharing) {
  std::vector<std::uint32_t> free;
  for (std::uint32_t contact = 0; contact < taken.size(); ++contact) {
    if (taken[contact] == kNoContact && sharing[contact] == kNoContact) free.push_back(contact);
  }
  return free;
}

/// The state of a matching: who is taken, on either side.
struct Matching {
  ContactMatches matches;
  std::vector<std::uint32_t> later;  ///< of each earlier contact, the same one now

  void match(std::uint32_t before, std::uint32_t now) {
    if (later[before] != kNoContact || matches.earlier[now] != kNoContact) return;
    later[before] = now;
    matches.earlier[now] = before;
  }
};

/// Matches by shared pillars, and notes what those left over split from or merged into.
void match_by_pillars(const ContactTraces& before, const ContactTraces& now, Matching& matching) {
  std::vector<Shared> pairs = shared_pillars(before, now);
  std::sort(pairs.begin(), pairs.end(), [&](const Shared& a, const Shared& b) {
    return std::tie(b.pillars, before.ids[a.before], a.now) <
           std::tie(a.pillars, before.ids[b.before], b.now);
  });
  for (const Shared& pair : pairs) matching.match(pair.before, pair.now);
  for (const Shared& pair : pairs) {
    std::uint32_t& parent = matching.matches.parents[pair.now];
    std::uint32_t& merged = matching.matches.merged[pair.before];
    if (matching.matches.earlier[pair.now] == kNoContact && parent == kNoContact) {
      parent = pair.before;
    }
    if (matching.later[pair.before] == kNoContact && merged == kNoContact) merged = pair.now;
  }
}

void match_by_distance(const ContactTraces& before, const ContactTraces& now, double reach_mm,
                       Matching& matching) {
  if (!(reach_mm > 0)) return;
  const std::vector<std::uint32_t> lost = free_ones(matching.later, matching.matches.merged);
  const std::vector<std::uint32_t> found =
      free_ones(matching.matches.earlier, matching.matches.parents);
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

ContactMatches match_contacts(const ContactTraces& before, const ContactTraces& now,
                              double reach_mm) {
  Matching matching;
  matching.later.assign(before.ids.size(), kNoContact);
  matching.matches.merged.assign(before.ids.size(), kNoContact);
  matching.matches.earlier.assign(now.centres.size(), kNoContact);
  matching.matches.parents.assign(now.centres.size(), kNoContact);
  match_by_pillars(before, now, matching);
  match_by_distance(before, now, reach_mm, matching);
  return std::move(matching.matches);
}

}  // namespace pillarfield
