#pragma once

#include <array>
#include <memory>
#include <optional>

#include "device/calibration_memory.h"
#include "device/contact_stage.h"
#include "device/slot_layout.h"
#include "device/slot_scheduler.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// What frames leave to the next one on the device: the tare of a followed baseline or of a bent
/// skin, and the states of sensels. Frames in flight are then ordered: a reader waits for the last
/// writer, a writer for all readers.
struct FrameOrder {
  bool is_needed = false;
  bool each_writes = false;  ///< every frame; else those with a change of curvature
  bool follows_baseline = false;
  float rate = 0;           ///< rate of the tare per update of a row
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

  /// Whether wait() would return at once.
  [[nodiscard]] virtual bool is_done() = 0;

  /// The results of the frame, after wait().
  [[nodiscard]] virtual const ResultMemory& memory() const = 0;

  /// Estimates the ambiguous pillars of the frame, after wait().
  void resolve(ContactStage& contacts) const { contacts.resolve(memory()); }

  /// Results of the frame, after wait().
  [[nodiscard]] ForceFieldView results() const;

 protected:
  Slot(const Skin& skin, FrameOrder& order)
      : rows_(skin.element_rows()), cols_(skin.element_cols()), order_(&order) {}

  [[nodiscard]] FrameOrder& order() const { return *order_; }

 private:
  std::uint32_t rows_;  ///< pillars, or sensels without pillars
  std::uint32_t cols_;
  FrameOrder* order_;
};

}  // namespace pillarfield
