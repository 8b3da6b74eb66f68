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

/// Returns the slip test of a contact, if any. Called once per contact by pool thread `member`.
using SlipTestOf =
    std::function<std::optional<SlipTest>(std::uint32_t contact, std::size_t member)>;

/// Computes the ContactSum of each contact in several threads. Large contacts are split between
/// runs at places independent of the number of threads, so the bits are too.
class ParallelContactMoments {
 public:
  /// `threads` 0: one per hardware thread. Threads start at the first frame with more than one
  /// batch and sleep between frames.
  explicit ParallelContactMoments(std::uint32_t threads);

  /// The sum of each contact, by label, with slip if it has a test. Valid until the next
  /// call.
  const std::vector<ContactSum>& measure(const ForceFieldView& forces, const ContactLabels& labels,
                                         const SlipTestOf& test_of);

  [[nodiscard]] std::size_t threads() const { return threads_; }

 private:
  /// Consecutive runs of one contact.
  struct Part {
    std::uint32_t contact = 0;
    std::span<const ContactRun> runs;
    ContactSum sum;
  };

  void split(const ContactLabels& labels);
  void test(std::size_t batch, std::size_t member, const SlipTestOf& test_of);
  void sum(std::size_t batch, const ForceFieldView& forces);

  std::size_t threads_;
  std::unique_ptr<ThreadPool> pool_;  ///< null before the first frame of several batches
  std::vector<Part> parts_;           ///< by label
  std::vector<std::size_t> batches_;  ///< first part of each batch, and one past the last
  std::vector<ContactSum> sums_;
  std::vector<std::optional<SlipTest>> tests_;
  std::vector<char> is_tested_;  ///< of each contact
};

}  // namespace pillarfield
