#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_file.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"

namespace pillarfield {

/// Consecutive frames, from `first` to before `end`.
struct FrameRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;
};

/// Options of solve_range().
struct RangeOptions {
  std::optional<ContactOptions> contacts = {};  ///< track contacts with these options
  /// Frames before the range that are solved first, and not passed on. Unset: warm_up_frames().
  std::optional<std::uint64_t> warm_up = {};
  Processor::Options processor = {.frames_in_flight = 3};
  std::function<bool()> stop = {};  ///< as Pipeline::Options::stop
};

/// Number of earlier frames that matter to a frame of such a solve: three time constants of a
/// followed baseline and of creep, and three seconds for friction, contacts, hysteresis and
/// bending; 0 if no state passes from frame to frame.
[[nodiscard]] std::uint64_t warm_up_frames(const SolverPlan& plan, bool contacts);

/// Solves the frames of a range and passes them to sinks, which it does not finish. The frames
/// before it, as many as the warm-up has, are solved first, so that the range begins with their
/// state; ids of contacts count from there. Without such memory, the bits are those of a solve of
/// all frames.
///
/// Throws Error if the range is empty or reaches beyond the frames of the source, and as Pipeline.
PipelineStatistics solve_range(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const FrameRange& range, const RangeOptions& options,
                               const std::vector<ForceSink*>& sinks);

}  // namespace pillarfield
