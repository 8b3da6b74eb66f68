#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_file.h"
#include "pillarfield/force_parts.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"

namespace pillarfield {

/// How ranges of frames are solved.
struct RangeOptions {
  std::optional<ContactOptions> contacts = {};  ///< track contacts with these options
  Checkpoints checkpoints = {};
  Processor::Options processor = {.frames_in_flight = 3};
  std::function<bool()> stop = {};  ///< as Pipeline::Options::stop
};

/// Whether a frame of such a solve depends on earlier ones: through a followed baseline, a bent
/// skin, hysteresis, creep, friction carried over, or the identity of contacts.
[[nodiscard]] bool carries_state(const SolverPlan& plan, bool contacts);

/// Solves the frames of a range and passes them to sinks, which it does not finish.
///
/// At each checkpoint, state begins anew: the processor and the tracker of contacts are made again
/// and given Checkpoints::warm_up frames before. A followed baseline begins with the drift that ten
/// frames of each earlier distance show. Hence the same
/// bits in a range that begins at a checkpoint and in all frames. Contacts after a checkpoint have
/// new ids.
///
/// Throws Error if the plan carries state and the range begins at no checkpoint, and as Pipeline.
PipelineStatistics solve_range(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const FrameRange& range, const RangeOptions& options,
                               const std::vector<ForceSink*>& sinks);

/// 16 hexadecimal digits that differ, but for chance, if frames, plan, calibration or options of
/// contacts do. Of the frames, 32 are read: the first, the last, and evenly spaced ones.
[[nodiscard]] std::string fingerprint_of(FrameSource& source, const SolverPlan& plan,
                                         const std::optional<ContactOptions>& contacts);

/// Solves one part of an output into part_file(), unless that holds it already; makes its folder.
/// `info` describes the output, `part` all but its fingerprint, and `others` are passed the frames
/// too. Returns nothing if the part was whole. A part that ends early leaves no file.
///
/// Throws Error as solve_range(), and if another process writes the part.
std::optional<PipelineStatistics> solve_part(FrameSource& source, const Device& device,
                                             const SolverPlan& plan, const RangeOptions& options,
                                             const std::filesystem::path& output,
                                             ForceFileInfo info, ForcePart part,
                                             std::vector<ForceSink*> others = {});

}  // namespace pillarfield
