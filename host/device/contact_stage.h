#pragma once

#include "contacts/estimator/contact_estimator.h"
#include "device/device_state.h"
#include "device/slot_memory.h"
#include "pillarfield/contact_labels.h"

namespace pillarfield {

/// The estimator `contact` of a processor: goes over a frame that the direct solve left, on the
/// host's side of its planes, where its results are wanted: the same bits whatever the device. One
/// for all slots, whose frames come one after the other.
class ContactStage {
 public:
  ContactStage(const Device::State& device, const SolverPlan& plan);

  /// Estimates the ambiguous pillars of a frame whose planes lie in `memory`.
  void resolve(const SlotMemory& memory);

  /// The contacts of that frame.
  [[nodiscard]] FoundContacts contacts() const {
    return {&estimator_.contacts(), estimator_.friction()};
  }

 private:
  std::uint32_t rows_;
  std::uint32_t cols_;
  ContactEstimator estimator_;
};

}  // namespace pillarfield
