#pragma once

#include "contacts/estimator/contact_estimator.h"
#include "device/slot_memory.h"
#include "pillarfield/contact_labels.h"

namespace pillarfield {

/// The estimator `contact` of a processor. Runs on the host, on the planes of a frame after the
/// direct solve: equal bits on all devices. All slots share it, since frames are resolved in order.
class ContactStage {
 public:
  ContactStage(const SolverPlan& plan, std::size_t threads);

  /// Estimates the ambiguous pillars of a frame whose planes lie in `memory`.
  void resolve(const ResultMemory& memory);

  /// The contacts of the frame last resolved.
  [[nodiscard]] FoundContacts contacts() const {
    return {&estimator_.contacts(), estimator_.friction()};
  }

 private:
  std::uint32_t rows_;
  std::uint32_t cols_;
  ContactEstimator estimator_;
};

}  // namespace pillarfield
