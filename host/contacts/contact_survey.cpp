#include "contacts/contact_survey.h"

#include <algorithm>
#include <limits>
#include <thread>

namespace pillarfield {
namespace {

/// So many lots to a thread: none waits long for the last.
constexpr std::uint64_t kLotsPerThread = 8;

/// Fewer pillars, some microseconds, are not worth waking a thread.
constexpr std::uint64_t kLeastShare = 2048;

std::size_t threads_for(std::uint32_t wanted) {
  return wanted != 0 ? wanted : std::max(std::thread::hardware_concurrency(), 1U);
}

}  // namespace

ContactSurvey::ContactSurvey(std::uint32_t threads) : threads_(threads_for(threads)) {}

/// Shares of pillars, and from them lots of contacts.
void ContactSurvey::share_out(const ContactMap& map) {
  const std::uint64_t all = pillars_of(map.runs());
  const bool one_lot = threads_ == 1 || all < 2 * kLeastShare;
  share_ = one_lot ? std::numeric_limits<std::uint64_t>::max() / 2
                   : std::max(kLeastShare, all / (kLotsPerThread * threads_));
  lots_.clear();
  Lot lot;
  std::uint64_t pillars = 0;
  const auto close = [&](std::uint32_t next) {
    if (lot.first < lot.end) lots_.push_back(lot);
    lot = {next, next, false};
    pillars = 0;
  };
  for (std::uint32_t contact = 0; contact < map.contacts(); ++contact) {
    const std::uint64_t more = pillars_of(map.runs(contact));
    const bool large = more > 2 * share_;
    if (large) close(contact);
    lot.end = contact + 1;
    lot.large = large;
    pillars += more;
    if (pillars >= share_) close(contact + 1);
  }
  close(map.contacts());
}

void ContactSurvey::measure_lot(const Lot& lot, const ContactMeasure& measure,
                                const ContactMap& map, const FrictionOf& friction_of,
                                std::size_t member) {
  for (std::uint32_t contact = lot.first; contact < lot.end; ++contact) {
    frictions_[contact] = friction_of(contact, member);
    if (!lot.large) totals_[contact] = measure.totals(map.runs(contact), frictions_[contact]);
  }
}

const std::vector<ContactTotals>& ContactSurvey::measure(const ContactMeasure& measure,
                                                         const ContactMap& map,
                                                         const FrictionOf& friction_of) {
  totals_.assign(map.contacts(), {});
  frictions_.assign(map.contacts(), {});
  share_out(map);
  run(lots_.size(), [&](std::size_t piece, std::size_t member) {
    measure_lot(lots_[piece], measure, map, friction_of, member);
  });
  parts_.clear();
  for (const Lot& lot : lots_) {
    if (lot.large) add_parts(lot.first, map.runs(lot.first));
  }
  sum_parts(measure);
  for (const Part& part : parts_) {
    totals_[part.contact].sum.add(part.totals.sum);
    totals_[part.contact].slip.add(part.totals.slip);
  }
  return totals_;
}

/// Cuts the runs of a contact into parts of a share each, or some more.
void ContactSurvey::add_parts(std::uint32_t contact, std::span<const ContactRun> runs) {
  std::size_t first = 0;
  std::uint64_t pillars = 0;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    pillars += runs[i].end - runs[i].first;
    if (pillars < share_ && i + 1 < runs.size()) continue;
    parts_.push_back({contact, runs.subspan(first, i + 1 - first), frictions_[contact], {}});
    first = i + 1;
    pillars = 0;
  }
}

void ContactSurvey::sum_parts(const ContactMeasure& measure) {
  run(parts_.size(), [&](std::size_t piece, std::size_t) {
    Part& part = parts_[piece];
    part.totals = measure.totals(part.runs, part.friction);
  });
}

/// Does all pieces, with the others' help if there are several.
void ContactSurvey::run(std::size_t pieces, const WorkTeam::Work& work) {
  if (pieces > 1 && threads_ > 1 && !team_) team_ = std::make_unique<WorkTeam>(threads_);
  if (team_ && pieces > 1) {
    team_->run(pieces, work);
    return;
  }
  for (std::size_t piece = 0; piece < pieces; ++piece) work(piece, 0);
}

}  // namespace pillarfield
