#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/contact_measure.h"
#include "core/contact_totals.h"
#include "core/work_team.h"
#include "pillarfield/contact_map.h"

namespace pillarfield {

/// What a contact of a frame shows by itself.
struct ShownContact {
  ContactTotals totals;            ///< slip included where there is a friction
  std::optional<double> friction;  ///< what was given, or what it shows
};

/// A contact, and the friction to judge its slip by.
struct AssumedFriction {
  std::uint32_t contact = 0;  ///< number in the map
  double friction = 0;
};

/// Measures the contacts of frame after frame in several threads, which take them by lots of about
/// as many pillars; a large contact is cut between its runs. All sums are of whole numbers, so the
/// bits do not depend on the number of threads.
class ContactSurvey {
 public:
  /// `threads` 0: as many as the processor has. They start at the first frame that is worth sharing
  /// and sleep between frames.
  explicit ContactSurvey(std::uint32_t threads);

  /// One for each contact of the map, by `given` or its own friction; stays until the next call.
  const std::vector<ShownContact>& measure(const ContactMeasure& measure, const ContactMap& map,
                                           const std::optional<double>& given);

  /// How contacts of the same map slip by other frictions, one for each.
  std::vector<PressingSum> slip(const ContactMeasure& measure, const ContactMap& map,
                                std::span<const AssumedFriction> assumed);

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
    std::size_t place = 0;  ///< of its contact in what is asked
    std::span<const ContactRun> runs;
    std::optional<double> friction;
    ContactTotals totals;
  };

  void share_out(const ContactMap& map);
  void measure_lot(const Lot& lot, const ContactMeasure& measure, const ContactMap& map,
                   const std::optional<double>& given, std::size_t member);
  void add_parts(std::size_t place, std::span<const ContactRun> runs,
                 const std::optional<double>& friction);
  void sum_parts(const ContactMeasure& measure);
  void run(std::size_t pieces, const WorkTeam::Work& work);

  std::size_t threads_;
  std::unique_ptr<WorkTeam> team_;  ///< null as long as there was nothing to share
  std::vector<std::unique_ptr<FrictionHistogram>> histograms_;  ///< of each thread that needed one
  std::uint64_t share_ = 0;  ///< pillars of a lot or a part, or some more
  std::vector<Lot> lots_;
  std::vector<Part> parts_;
  std::vector<ShownContact> shown_;
};

}  // namespace pillarfield
