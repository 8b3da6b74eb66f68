#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/live.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Description, for live sinks, of frames that are solved by `plan` on `device` (its name, or
/// empty). `contacts` are set for sinks that write them.
[[nodiscard]] LiveSinkInfo live_sink_info(const SolverPlan& plan, const std::string& device,
                                          const std::string& source,
                                          const std::optional<ContactOptions>& contacts = {});

/// A tare or a recording that a LiveSession has finished.
struct LiveEvent {
  enum class Kind : std::uint8_t { tare, recording };
  Kind kind = Kind::tare;
  std::uint64_t tag = 0;   ///< of start_tare() or stop_recording()
  std::string error = {};  ///< why it failed; empty: done
  /// The recording that was completed, or the one that keeps the tare of its start; empty: none.
  std::string recording = {};
  std::string note = {};  ///< what a tare that was taken says of itself: LiveTare::note()
  LiveSinkStatistics recorded = {};  ///< of a recording that was completed
};

/// Frames of a live stream through the solver to live sinks, and what a user may do meanwhile:
/// measure the tare, pause, record. The session watches for faulty sensels and counts latencies.
///
/// run() is called by one thread; the other methods by any, and they do not wait for frames.
class LiveSession {
 public:
  struct Run {
    int frames_in_flight = 2;                  ///< at most that of the processor
    ContactTracker* contacts = nullptr;        ///< null: contacts are not tracked
    std::optional<std::uint64_t> frames = {};  ///< end after this many, of all runs
    ForceSink* sink = nullptr;                 ///< gets each frame after the live sinks
    std::function<bool()> stop = {};           ///< as Pipeline::Options has it
  };

  /// All arguments but `info` must outlive the session. The plan, for which `processor` is made,
  /// has a tare, if of zeros, so that one can be measured. `info` describes recordings.
  /// `keeps_threshold`: the user stated the threshold, so that a tare leaves it as it is.
  LiveSession(FrameStream& source, const SolverPlan& plan, Processor& processor, LiveSinkInfo info,
              bool keeps_threshold = false);
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  void add(std::unique_ptr<LiveSink> sink);

  /// Runs until the source ends, `stop` returns true or `frames` have come, beginning with those
  /// that wait. May be called again to continue. Throws what Pipeline::run()
  /// throws.
  PipelineStatistics run(const Run& options);

  /// Completes all sinks, and waits for recordings that are being completed.
  void finish();

  /// Measures tare, noise and threshold of the untouched skin over this time, for all frames after
  /// it; `preloaded` as LiveTare has it. An event tells the end. Returns false where one is being
  /// measured. `holds`: frames before its end are not solved, and reach no sink; all, if it fails.
  bool start_tare(std::chrono::nanoseconds duration, bool preloaded = false, std::uint64_t tag = 0,
                  bool holds = false);
  [[nodiscard]] bool is_taring() const;

  /// While paused, frames are received and counted, but not solved.
  void set_paused(bool paused);
  [[nodiscard]] bool is_paused() const;

  /// Records the raw frames from now on. A recording states one tare for all of its frames: that of
  /// its start or, if it has none or one is being measured, the next one. Throws Error where the
  /// file cannot be made, or a recording runs.
  void record(const std::filesystem::path& path);
  /// The file that is being recorded; empty: none.
  [[nodiscard]] std::string recording() const;
  /// Ends the recording; it is completed in a thread, and an event tells the end. Returns false
  /// where none runs.
  bool stop_recording(std::uint64_t tag = 0);

  /// Description of frames by the current plan: the constructor's, or with the tare taken last.
  [[nodiscard]] LiveSinkInfo info() const;

  /// The events since the last call, in order.
  [[nodiscard]] std::vector<LiveEvent> take_events();

  struct Sink {
    std::string name;
    LiveSinkStatistics statistics;
  };
  [[nodiscard]] std::vector<Sink> sinks() const;

  /// The health since the last report().
  [[nodiscard]] HealthReport health() const;
  /// Passes the health since the last call to all sinks, and starts counting again.
  HealthReport report();

  /// The latency in ms that a `fraction` (0..1) of all frames did not exceed, to 2.4 %, with `lost`
  /// ones as later than all others; unset where that is one of them.
  [[nodiscard]] std::optional<double> latency_ms(double fraction, std::uint64_t lost = 0) const;
  [[nodiscard]] double worst_latency_ms() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pillarfield
