#include "pillarfield/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "pipeline/frame_loop.h"
#include "pipeline/missing_pillars.h"

namespace pillarfield {

/// The ring of run_frames().
struct Pipeline::State {
  State(FrameStream& frame_stream, Processor& frame_processor, std::vector<ForceSink*> frame_sinks,
        Options run_options)
      : stream(frame_stream),
        processor(frame_processor),
        sinks(std::move(frame_sinks)),
        options(std::move(run_options)) {
    if (options.frames_in_flight < 1) {
      throw Error("pipeline", fmt::format("{} frames in flight", options.frames_in_flight),
                  "give 1 or more");
    }
    for (int i = 0; i < options.frames_in_flight; ++i) {
      frames.emplace_back(processor.frame_buffer());
      check(frames.back().buffer.view(), stream.skin(), stream.sensel_type(), "pipeline");
    }
  }

  [[nodiscard]] int capacity() const { return options.frames_in_flight; }
  [[nodiscard]] int in_flight() const { return processor.in_flight(); }
  [[nodiscard]] StreamedFrame& vacant() { return frames[submitted % frames.size()]; }
  void submit() {
    processor.submit(vacant().readings);
    ++submitted;
  }
  void deliver();
  void abandon();

  FrameStream& stream;
  Processor& processor;
  std::vector<ForceSink*> sinks;
  Options options;
  std::vector<StreamedFrame> frames;
  std::uint64_t submitted = 0;
  std::uint64_t delivered = 0;
  MissingPillars missing;
  PipelineStatistics done;
};

void Pipeline::State::deliver() {
  const StreamedFrame& frame = frames[delivered % frames.size()];
  SolvedFrame solved;
  solved.forces = processor.receive();
  ++delivered;
  const bool is_whole = frame.missing.empty();
  if (!is_whole) solved.forces = missing.without(solved.forces, frame.missing);
  solved.readings = frame.readings;
  solved.missing = frame.missing;
  solved.time_s = frame.time_s;
  solved.sequence = frame.sequence;
  solved.arrived = frame.arrived;
  if (options.contacts != nullptr) {
    const FrameContacts& found = options.contacts->update(
        solved.forces, frame.time_s, is_whole ? processor.contacts() : FoundContacts{});
    solved.contacts = &found;
    done.most_contacts = std::max(done.most_contacts, found.contacts.size());
    for (const TrackedContact& contact : found.contacts) {
      done.contacts = std::max(done.contacts, contact.track_id);
    }
  }
  for (ForceSink* const sink : sinks) sink->append(solved);
  ++done.frames;
}

/// Waits for all frames in flight, so that their memory may be freed.
void Pipeline::State::abandon() {
  try {
    while (processor.in_flight() > 0) static_cast<void>(processor.receive());
  } catch (const Error&) {
    // The device failed; run() rethrows the original error.
  }
  delivered = submitted;
}

Pipeline::Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks,
                   const Options& options)
    : state_(std::make_unique<State>(stream, processor, std::move(sinks), options)) {}
Pipeline::Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks)
    : Pipeline(stream, processor, std::move(sinks), Options{}) {}
Pipeline::~Pipeline() = default;
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;

PipelineStatistics Pipeline::run() {
  state_->done = {};
  try {
    run_frames(state_->stream, *state_, state_->options.stop, state_->done);
  } catch (...) {
    state_->abandon();
    throw;
  }
  return state_->done;
}

namespace {

class CallbackSink final : public ForceSink {
 public:
  explicit CallbackSink(std::function<void(const SolvedFrame&)> call) : call_(std::move(call)) {}
  void append(const SolvedFrame& frame) override { call_(frame); }

 private:
  std::function<void(const SolvedFrame&)> call_;
};

}  // namespace

std::unique_ptr<ForceSink> callback_sink(std::function<void(const SolvedFrame&)> call) {
  return std::make_unique<CallbackSink>(std::move(call));
}

}  // namespace pillarfield
