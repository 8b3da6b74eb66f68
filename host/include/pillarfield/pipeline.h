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

/// What a pipeline has done.
struct PipelineStatistics {
  std::uint64_t frames = 0;       ///< solved and taken by every sink
  std::uint64_t lost = 0;         ///< gaps in the sequence numbers, the first frame being none
  std::uint64_t contacts = 0;     ///< different ones; 0 without a tracker
  std::size_t most_contacts = 0;  ///< in one frame
  bool stopped = false;           ///< ended by Options::stop, not by the stream
};

/// Takes frames from a stream, solves them, tracks their contacts and gives them to sinks.
///
///     auto source = open_frames("press.h5");
///     auto stream = file_stream(*source);
///     Processor processor(open_device(), plan);
///     auto sink = create_force_sink("forces.h5", info);
///     Pipeline(*stream, processor, {sink.get()}).run();
///     sink->finish();
///
/// Frames keep their order. Several are in flight, so reading and writing overlap with solving; a
/// frame waits for others only while these are there. All sinks run in the thread of run(): a slow
/// one holds up the stream, which then drops frames or lets them wait.
class Pipeline {
 public:
  struct Options {
    int frames_in_flight = 2;            ///< at most those of the processor
    ContactTracker* contacts = nullptr;  ///< null: contacts are not tracked
    /// Asked before each frame, and ten times a second while none comes; true ends the run.
    std::function<bool()> stop = {};
  };

  /// Makes a place for each frame in flight. All arguments must outlive the pipeline; `processor`
  /// is that of a plan for the stream's frames, and nobody else uses it during run().
  Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks,
           const Options& options);
  Pipeline(FrameStream& stream, Processor& processor, std::vector<ForceSink*> sinks);
  ~Pipeline();
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;

  /// Runs until the stream ends or `stop` says so; frames in flight are then delivered. May be
  /// called again to go on. Takes no memory of its own. Throws what stream, processor, tracker or
  /// sink throws, after the frames in flight were solved; no sink gets them. Sinks are not
  /// finished: what stopped or failed may be worth less than a file under its final name.
  PipelineStatistics run();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
