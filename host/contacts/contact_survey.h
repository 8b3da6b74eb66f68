#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/work_team.h"
#include "contacts/contact_measure.h"
#include "contacts/contact_totals.h"
#include "pillarfield/contact_map.h"

namespace pillarfield {

/// Tells the friction of a contact, if it is known, to a member of the team. Called once for each
/// contact, in any thread.
using FrictionOf = std::function<std::optional<double>(std::uint32_t contact, std::size_t member)>;

/// Measures the contacts of frame after frame in several threads, which take them by lots of about
/// as many pillars; a large contact is cut between its runs. All sums are of whole numbers, so the
/// bits do not depend on the number of threads.
class ContactSurvey {
 public:
  /// `threads` 0: as many as the processor has. They start at the first frame that is worth sharing
  /// and sleep between frames.
  explicit ContactSurvey(std::uint32_t threads);

  /// The sums of each contact of the map, with its slip where its friction is known; they stay
  /// until the next call.
  const std::vector<ContactTotals>& measure(const ContactMeasure& measure, const ContactMap& map,
                                            const FrictionOf& friction_of);

  [[nodiscard]] std::size_t threads() const { return threads_; }

 private:
  /// Contacts that one thread takes together; a large one is by itself, and only its friction is
  /// asked.
  struct Lot {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
    bool large = false;
  };

  /// Runs of a contact that are summed together.
  struct Part {
    std::uint32_t contact = 0;
    std::span<const ContactRun> runs;
    std::optional<double> friction;
    ContactTotals totals;
  };

  void share_out(const ContactMap& map);
  void measure_lot(const Lot& lot, const ContactMeasure& measure, const ContactMap& map,
                   const FrictionOf& friction_of, std::size_t member);
  void add_parts(std::uint32_t contact, std::span<const ContactRun> runs);
  void sum_parts(const ContactMeasure& measure);
  void run(std::size_t pieces, const WorkTeam::Work& work);

  std::size_t threads_;
  std::unique_ptr<WorkTeam> team_;  ///< null as long as there was nothing to share
  std::uint64_t share_ = 0;         ///< pillars of a lot or a part, or some more
  std::vector<Lot> lots_;
  std::vector<Part> parts_;
  std::vector<ContactTotals> totals_;
  std::vector<std::optional<double>> frictions_;
};

}  // namespace pillarfield
