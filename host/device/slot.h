#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "contacts/estimator/contact_estimator.h"
#include "device/slot_memory.h"
#include "device/slot_scheduler.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/processor.h"

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
  ContactEstimator estimator_;
};

/// State that frames leave to the next one on the device: the tare of a followed baseline or of a
/// bent skin, and the states of sensels. Frames in flight are then ordered: a reader waits for the
/// last writer, a writer for all readers.
struct FrameOrder {
  bool is_needed = false;
  bool each_writes = false;  ///< every frame; else those with a change of curvature
  bool follows_baseline = false;
  single_precision::BaselinePace pace{};
  cl_uint interval = 1;     ///< frames between updates of a pillar row
  std::uint64_t frame = 0;  ///< number of frames submitted
  cl::Event left;           ///< completion of the last that wrote; null before the first
  std::array<cl::Event, kMostSlots> readers;  ///< the last frames, which read what that left

  /// The pillar row that the frame submitted last updates first.
  [[nodiscard]] cl_uint first_row() const { return static_cast<cl_uint>((frame - 1) % interval); }
};

/// One frame in flight, with memory of its own.
class Slot {
 public:
  virtual ~Slot() = default;
  Slot(const Slot&) = delete;
  Slot& operator=(const Slot&) = delete;

  /// Starts solving the frame, after a change of the skin's curvature if given; `drift` is that of
  /// touched tares after it. The slot must not be in flight.
  virtual void submit(const FrameView& frame, const std::optional<Curvature>& bent,
                      const single_precision::Drift& drift) = 0;

  virtual void wait() = 0;

  /// True if wait() would return at once.
  [[nodiscard]] virtual bool is_done() = 0;

  /// The results of the frame, after wait().
  [[nodiscard]] virtual const ResultMemory& memory() const = 0;

  /// Estimates the ambiguous pillars of the frame, after wait().
  void resolve(ContactStage& contacts) const { contacts.resolve(memory()); }

  /// Results of the frame, after wait().
  [[nodiscard]] ForceFieldView results() const { return memory().forces(); }

  /// Blocks without contacts of a frame with pillars, after wait(), if the host sees them.
  [[nodiscard]] FoundContacts contacts() const;

 protected:
  Slot(const Skin& skin, FrameOrder& order) : has_pillars_(skin.has_pillars()), order_(&order) {}

  [[nodiscard]] FrameOrder& order() const { return *order_; }

 private:
  bool has_pillars_;
  FrameOrder* order_;
};

}  // namespace pillarfield
