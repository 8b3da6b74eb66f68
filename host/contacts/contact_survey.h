#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/thread_pool.h"
#include "contacts/contact_sum.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// Returns the friction of a contact, if it is known, in a member of the team. Called once for each
/// contact, in any thread.
using FrictionOf = std::function<std::optional<double>(std::uint32_t contact, std::size_t member)>;

/// Sums over the contacts of frame after frame in several threads. A large contact is cut between
/// its runs, wherever the number of threads is; so the bits do not depend on that.
class ContactSurvey {
 public:
  /// `threads` 0: as many as the processor has. They start at the first frame that is worth sharing
  /// and sleep between frames.
  explicit ContactSurvey(std::uint32_t threads);

  /// The sums of each contact of the map, with its slip where its friction is known; they stay
  /// until the next call.
  const std::vector<ContactSum>& measure(const ForceFieldView& forces, const ContactLabels& map,
                                         const FrictionOf& friction_of);

  [[nodiscard]] std::size_t threads() const { return threads_; }

 private:
  /// Runs of one contact that are summed together.
  struct Part {
    std::uint32_t contact = 0;
    std::span<const ContactRun> runs;
    ContactSum sum;
  };

  void cut(const ContactLabels& map);
  /// Calls `work(first, end, member)` for batches of consecutive parts, until all are done.
  template <class Work>
  void share_out(const Work& work);

  std::size_t threads_;
  std::unique_ptr<ThreadPool> team_;  ///< null as long as there was nothing to share
  std::vector<Part> parts_;           ///< contact by contact
  std::vector<std::size_t> batches_;  ///< the first part of each, and one past the last
  std::vector<ContactSum> sums_;
  std::vector<std::optional<double>> ratios_;
};

}  // namespace pillarfield
