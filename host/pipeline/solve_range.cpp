#include "pillarfield/solve_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/force_parts.h"
#include "pillarfield/processor.h"
#include "pillarfield/recording.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

/// Follows the baseline through a few frames of each checkpoint's distance, so that the tare at a
/// checkpoint has the drift of all frames before it. The result depends on the checkpoints alone.
class BaselineSurvey {
 public:
  /// The plan must follow the baseline, on a skin that is not bent.
  BaselineSurvey(FrameSource& source, const Device& device, const SolverPlan& plan,
                 const Checkpoints& checkpoints);

  /// The tare at a frame, not before that of the last call, [sensel rows, cols], counts; of an
  /// earlier one once `stop` returns true.
  [[nodiscard]] std::vector<float> tare_at(std::uint64_t frame, const std::function<bool()>& stop);

 private:
  FrameSource& source_;
  std::uint64_t step_;
  std::uint64_t next_ = 0;
  FrameBuffer frame_;
  Processor processor_;
};

constexpr std::uint64_t kFramesOfDistance = 10;

std::uint64_t survey_step(const Checkpoints& checkpoints) {
  return std::max<std::uint64_t>(checkpoints.every / kFramesOfDistance, 1);
}

/// The plan for every step-th frame, without what does not change the tare.
SolverPlan survey_plan(SolverPlan plan, std::uint64_t step) {
  // A single frame never sets the tare, since its noise would.
  constexpr double kMostRate = 0.5;
  const auto frames = static_cast<double>(step);
  plan.baseline_rate = std::min(1 - std::pow(1 - *plan.baseline_rate, frames), kMostRate);
  plan.baseline_interval = 1;
  plan.frame_interval_s *= frames;
  if (plan.estimator == Estimator::contact) plan.estimator = Estimator::direct;
  plan.angles = plan.uncertainty = false;
  return plan;
}

BaselineSurvey::BaselineSurvey(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const Checkpoints& checkpoints)
    : source_(source),
      step_(survey_step(checkpoints)),
      frame_(plan.sensel_type, plan.skin.rows, plan.skin.cols),
      processor_(device, survey_plan(plan, step_)) {}

std::vector<float> BaselineSurvey::tare_at(std::uint64_t frame, const std::function<bool()>& stop) {
  for (; next_ < frame; next_ += step_) {
    if (stop && stop()) break;
    source_.read(next_, frame_);
    processor_.submit(frame_.view());
    static_cast<void>(processor_.receive());
  }
  return processor_.tare();
}

/// Passes frames on, without those of a warm-up, and with ids of contacts above those before.
class SegmentSink final : public ForceSink {
 public:
  SegmentSink(std::uint64_t first, std::uint64_t ids_before, const std::vector<ForceSink*>& sinks)
      : first_(first), ids_before_(ids_before), largest_id_(ids_before), sinks_(sinks) {}

  void append(const SolvedFrame& frame) override {
    if (frame.sequence < first_) return;
    SolvedFrame passed = frame;
    if (frame.contacts != nullptr) passed.contacts = &renumbered(frame);
    for (ForceSink* const sink : sinks_) sink->append(passed);
    ++frames_;
  }

  [[nodiscard]] std::uint64_t largest_id() const { return largest_id_; }
  [[nodiscard]] std::size_t most_contacts() const { return most_contacts_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  const FrameContacts& renumbered(const SolvedFrame& frame) {
    contacts_ = *frame.contacts;
    most_contacts_ = std::max(most_contacts_, contacts_.contacts.size());
    for (TrackedContact& contact : contacts_.contacts) {
      contact.track_id += ids_before_;
      if (contact.parent) *contact.parent += ids_before_;
      largest_id_ = std::max(largest_id_, contact.track_id);
    }
    // Contacts that end with the warm-up were never passed on.
    if (frame.sequence == first_) contacts_.ended.clear();
    for (EndedContact& contact : contacts_.ended) {
      contact.track_id += ids_before_;
      if (contact.merged_into) *contact.merged_into += ids_before_;
    }
    return contacts_;
  }

  std::uint64_t first_;
  std::uint64_t ids_before_;
  std::uint64_t largest_id_;
  std::uint64_t frames_ = 0;
  std::size_t most_contacts_ = 0;
  const std::vector<ForceSink*>& sinks_;
  FrameContacts contacts_;
};

/// End of the frames that share the state of frame `first`.
std::uint64_t end_of_segment(std::uint64_t first, const FrameRange& range,
                             const Checkpoints& checkpoints) {
  if (checkpoints.every == 0) return range.end;
  return std::min((first / checkpoints.every + 1) * checkpoints.every, range.end);
}

void require_start(bool begins, const std::string& where) {
  if (begins) return;
  throw Error(where,
              "its frames depend on earlier ones: a followed baseline, hysteresis, creep, bending, "
              "friction or identities of contacts",
              "let them begin anew at some frames: --checkpoint-every, in Python checkpoint_every");
}

/// Whether a file that should hold a part can be read neither as forces nor as frames.
bool is_damaged(const std::filesystem::path& file) {
  if (is_force_file(file) || is_calibration_file(file)) return false;
  try {
    static_cast<void>(open_frames(file));
    return false;
  } catch (const Error&) {
    return true;
  }
}

/// Whether the tare follows drift. That of a bent skin also follows its curvature, which a
/// checkpoint finds anew.
bool follows_drift(const SolverPlan& plan) {
  return plan.baseline_rate.has_value() && plan.calibration.bend_x.empty();
}

}  // namespace

bool carries_state(const SolverPlan& plan, bool contacts) {
  const bool carries_friction = plan.estimator == Estimator::contact && plan.friction.memory;
  return contacts || carries_friction || has_memory_on_device(plan);
}

PipelineStatistics solve_range(FrameSource& source, const Device& device, const SolverPlan& plan,
                               const FrameRange& range, const RangeOptions& options,
                               const std::vector<ForceSink*>& sinks) {
  const bool has_state = carries_state(plan, options.contacts.has_value());
  const Checkpoints checkpoints = has_state ? options.checkpoints : Checkpoints{};
  if (has_state && range.first > 0) {
    require_start(checkpoints.every > 0 && range.first % checkpoints.every == 0,
                  fmt::format("the range from frame {}", range.first));
  }
  std::optional<BaselineSurvey> survey;
  if (has_state && checkpoints.every > 0 && follows_drift(plan)) {
    survey.emplace(source, device, plan, checkpoints);
  }
  PipelineStatistics done;
  for (std::uint64_t first = range.first; first < range.end && !done.stopped;) {
    const std::uint64_t end = end_of_segment(first, range, checkpoints);
    const std::uint64_t warm = first - std::min(first, checkpoints.warm_up);
    const auto stream = file_stream(source, warm, end);
    Processor processor(device, plan, options.processor);
    if (survey && warm > 0) {
      SolverPlan drifted = plan;
      drifted.calibration.tare = survey->tare_at(warm, options.stop);
      processor.set_plan(drifted);
    }
    std::optional<ContactTracker> tracker;
    if (options.contacts) tracker.emplace(plan.skin.element_pitch_mm(), *options.contacts);
    SegmentSink segment(first, done.contacts, sinks);
    Pipeline pipeline(*stream, processor, {&segment},
                      {.frames_in_flight = options.processor.frames_in_flight,
                       .contacts = tracker ? &*tracker : nullptr,
                       .stop = options.stop});
    done.stopped = pipeline.run().stopped;
    done.frames += segment.frames();
    done.contacts = segment.largest_id();
    done.most_contacts = std::max(done.most_contacts, segment.most_contacts());
    first = end;
  }
  return done;
}

std::optional<PipelineStatistics> solve_part(FrameSource& source, const Device& device,
                                             const SolverPlan& plan, const RangeOptions& options,
                                             const std::filesystem::path& output,
                                             ForceFileInfo info, ForcePart part,
                                             std::vector<ForceSink*> others) {
  part.frames = source.frames();
  part.checkpoints = {};
  if (carries_state(plan, options.contacts.has_value())) {
    part.checkpoints = options.checkpoints;
    require_start(part.count == 1 || part.checkpoints.every > 0,
                  fmt::format("part {} of {}", part.index, part.count));
  }
  check(part, output.string());
  part.fingerprint = fingerprint_of(source, plan, options.contacts);
  const std::filesystem::path file = part_file(output, part.index);
  if (holds_part(file, part)) return std::nullopt;
  require_same_division(file, part);
  std::error_code failed;
  std::filesystem::create_directory(file.parent_path(), failed);
  if (failed) throw Error(file.parent_path().string(), failed.message(), "check its directory");
  const FrameRange range = frames_of(part);
  info.part = part;
  info.contacts = options.contacts;
  const Replace replace = is_damaged(file) ? Replace::anything : Replace::results;
  const auto sink = create_force_sink(file, info, replace);
  others.push_back(sink.get());
  PipelineStatistics done = solve_range(source, device, plan, range, options, others);
  if (!done.stopped) sink->finish();
  return done;
}

}  // namespace pillarfield
