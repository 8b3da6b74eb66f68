#pragma once

#include <string>
#include <vector>

#include "bench/frames.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"

namespace pillarfield::bench {

/// Solves a series of frames with all slots of a processor in flight. A device with its own memory
/// gets them in Processor::frame_buffer()s. `frames` must outlive it.
class FrameSolver {
 public:
  FrameSolver(const Device& device, const SolverPlan& plan, const Frames& frames,
              const Processor::Options& options = {}, const ProcessorTuning& tuning = {});

  /// From now on `tracker`, which must outlive it, tracks the contacts of each result while the
  /// next frame is being solved.
  void track(ContactTracker& tracker) { tracker_ = &tracker; }

  /// Solves the next `frames` frames.
  void run(int frames);

  /// Solves one frame; the result is valid until run() or the next solve().
  ForceFieldView solve(const FrameView& frame);

  /// The name of the device that solves.
  [[nodiscard]] const std::string& device() const { return processor_.device().info().name; }

 private:
  void receive();

  const Frames* frames_;
  int most_in_flight_;
  std::vector<FrameBuffer> pinned_;  ///< copies of all frames: a slot gets another one each time
  Processor processor_;
  ContactTracker* tracker_ = nullptr;
  std::size_t submitted_ = 0;
  std::size_t received_ = 0;
};

}  // namespace pillarfield::bench
