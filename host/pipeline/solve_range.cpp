#include "pillarfield/solve_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pillarfield/error.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

/// Passes on the frames from `first`, without those of the warm-up.
class RangeSink final : public ForceSink {
 public:
  RangeSink(std::uint64_t first, const std::vector<ForceSink*>& sinks)
      : first_(first), sinks_(sinks) {}

  void append(const SolvedFrame& frame) override {
    if (frame.sequence < first_) return;
    SolvedFrame passed = frame;
    if (frame.sequence == first_ && frame.contacts != nullptr) {
      // Contacts that end with the warm-up were never passed on.
      contacts_ = *frame.contacts;
      contacts_.ended.clear();
      passed.contacts = &contacts_;
    }
    for (ForceSink* const sink : sinks_) sink->append(passed);
    ++frames_;
  }

  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  std::uint64_t first_;
  std::uint64_t frames_ = 0;
  const std::vector<ForceSink*>& sinks_;
  FrameContacts contacts_;
};

}  // namespace

std::uint64_t warm_up_frames(const SolverPlan& plan, bool contacts) {
  const bool carries_friction = estimator_of(plan) == Estimator::contact && plan.friction.memory;
  if (!contacts && !carries_friction && !has_memory_on_device(plan)) return 0;
  constexpr double kTimeConstants = 3;
  constexpr double kLeastSeconds = 3;
  constexpr double kMostFrames = 1e9;
  double seconds = kLeastSeconds;
  if (plan.calibration.effects.memory) {
    for (const Creep& creep : plan.calibration.effects.memory->creep) {
      seconds = std::max(seconds, kTimeConstants * creep.time_s);
    }
  }
  double frames = seconds / plan.frame_interval_s;
  if (plan.baseline_rate) frames = kMostFrames;  // It keeps what every touch has left.
  return static_cast<std::uint64_t>(std::ceil(std::min(frames, kMostFrames)));
}

PipelineStatistics solve_range(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const FrameRange& range, const RangeOptions& options,
                               const std::vector<ForceSink*>& sinks) {
  if (range.end > source.frames() || range.first > range.end ||
      (range.first == range.end && source.frames() > 0)) {
    throw Error(fmt::format("the frames {}:{}", range.first, range.end),
                fmt::format("there are {}", source.frames()),
                fmt::format("give frames within 0:{}", source.frames()));
  }
  const std::uint64_t warm_up =
      options.warm_up.value_or(warm_up_frames(plan, options.contacts.has_value()));
  const auto stream = file_stream(source, range.first - std::min(range.first, warm_up), range.end);
  Processor processor(device, plan, options.processor);
  std::optional<ContactTracker> tracker;
  if (options.contacts) tracker.emplace(plan.skin.element_pitch_mm(), *options.contacts);
  RangeSink passed(range.first, sinks);
  Pipeline pipeline(*stream, processor, {&passed},
                    {.frames_in_flight = options.processor.frames_in_flight,
                     .contacts = tracker ? &*tracker : nullptr,
                     .stop = options.stop});
  PipelineStatistics done = pipeline.run();
  done.frames = passed.frames();
  return done;
}

}  // namespace pillarfield
