#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_sink.h"
#include "pillarfield/frame_stream.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// A sink that calls a function for each frame, in the thread of Pipeline::run(): a control loop,
/// or a plot. What it throws ends the run.
[[nodiscard]] std::unique_ptr<ForceSink> callback_sink(
    std::function<void(const SolvedFrame&)> call);

/// Statistics of a run of a Pipeline.
struct PipelineStatistics {
  std::uint64_t frames = 0;       ///< solved and passed to every sink
  std::uint64_t lost = 0;         ///< missing sequence numbers after the first frame
  std::uint64_t contacts = 0;     ///< number of different contacts; 0 without a tracker
  std::size_t most_contacts = 0;  ///< largest number in one frame
  bool stopped = false;           ///< ended by Options::stop, not by the stream
};

/// Solves the frames of a stream, tracks their contacts and passes them to sinks.
///
///     auto source = open_frames("press.h5");
///     auto stream = file_stream(*source);
///     Processor processor(open_device(), plan);
///     auto sink = create_force_sink("forces.h5", info);
///     Pipeline(*stream, processor, {sink.get()}).run();
///     sink->finish();
///
/// A pillar with a reading in StreamedFrame::missing gets no force and the status of missing
/// sensels; its contacts are found without it.
///
/// Frames keep their order. Several are in flight, so reading and writing overlap with solving; a
/// frame never waits for one that has not arrived. Sinks run in the thread of run(): a slow sink
/// delays the stream, which then drops or queues frames.
class Pipeline {
 public:
  struct Options {
    int frames_in_flight = 2;            ///< at most that of the processor
    ContactTracker* contacts = nullptr;  ///< null: contacts are not tracked
    /// Called before each frame, and ten times a second while none arrives; true ends the run. It
    /// runs in the thread of run(), and may call Processor::set_tare().
    std::function<bool()> stop = {};
  };

  /// Allocates a buffer for each frame in flight. All arguments must outlive the pipeline. The plan
  /// of `processor` must fit the stream's frames, and no other code may use it during run().
  Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks,
           const Options& options);
  Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  /// Runs until the stream ends or `stop` returns true, then delivers the frames in flight. May be
  /// called again to continue. Allocates no memory. Rethrows errors of stream, processor, tracker
  /// and sinks after the frames in flight are solved, which no sink receives. Does not call
  /// ForceSink::finish(): an aborted run should not replace a file.
  PipelineStatistics run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
