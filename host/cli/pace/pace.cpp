// pillarfield pace: solves frames at a fixed rate and reports their latencies.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/pace/frames.h"
#include "cli/pace/report.h"
#include "cli/progress.h"
#include "pillarfield/error.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

Nanoseconds nanoseconds(double seconds) { return Nanoseconds(std::llround(1e9 * seconds)); }

PaceSchedule schedule_of(const PaceOptions& options) {
  constexpr double kMostFrames = 1e7;  // Each latency is kept in memory.
  const double frames = options.rate_hz * options.seconds;
  if (!(frames >= 0.5 && frames <= kMostFrames)) {
    throw Error(
        "--seconds",
        fmt::format("{:g} s at {:g} Hz are {:g} frames", options.seconds, options.rate_hz, frames),
        fmt::format("give {:g} to {:g}", 0.5 / options.rate_hz, kMostFrames / options.rate_hz));
  }
  return {.rate_hz = options.rate_hz,
          .frames = static_cast<std::uint64_t>(std::llround(frames)),
          .backlog_frames = options.backlog_frames,
          .spin = nanoseconds(1e-6 * options.spin_us)};
}

Nanoseconds deadline_of(const PaceOptions& options) {
  return nanoseconds(1e-3 * options.deadline_ms.value_or(1e3 / options.rate_hz));
}

/// The frame interval is that of the run, not of the file: repeated frames are new in time.
SolverPlan plan_of(const PaceOptions& options, const PaceFrames& frames) {
  SolverPlan plan;
  plan.skin = frames.skin;
  plan.sensel_type = frames.sensel_type;
  plan.calibration = frames.calibration;
  plan =
      plan_of(options.plan, std::move(plan), options.source, [&] { return 1 / options.rate_hz; });
  check(plan, options.source);  // Before the frames are loaded, which is slow.
  return plan;
}

/// Repeats the frames in memory.
class Replay final : public FrameStream {
 public:
  Replay(const PaceFrames& source, std::uint64_t frames) : source_(source), frames_(frames) {}

  [[nodiscard]] const Skin& skin() const override { return source_.skin; }
  [[nodiscard]] SenselType sensel_type() const override { return source_.sensel_type; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, Nanoseconds) override {
    frame.sequence = next_;
    if (next_ == frames_) return Arrival::ended;
    frame.readings = source_.loaded[next_++ % source_.loaded.size()].view();
    return Arrival::arrived;
  }

 private:
  const PaceFrames& source_;
  std::uint64_t frames_;
  std::uint64_t next_ = 0;
};

/// Records the latency of each frame, in memory allocated beforehand.
class LatencySink final : public ForceSink {
 public:
  explicit LatencySink(std::uint64_t frames) {
    latencies.resize(frames);  // Touches the pages.
    latencies.clear();
  }
  void append(const SolvedFrame& frame) override {
    latencies.push_back(std::chrono::steady_clock::now().time_since_epoch() - frame.arrived);
    status = frame.forces.status;
  }

  std::vector<Nanoseconds> latencies;
  std::span<const std::uint8_t> status;  ///< of the last frame; valid until the next submit
};

std::unique_ptr<FrameStream> paced(const PaceFrames& frames, const PaceSchedule& schedule) {
  return paced_stream(
      std::make_unique<Replay>(frames, schedule.frames),
      {.rate_hz = schedule.rate_hz,
       .drop_after = nanoseconds(static_cast<double>(schedule.backlog_frames) / schedule.rate_hz),
       .spin = schedule.spin});
}

/// Solves a frame in every slot, so that the memory of its results is paged in.
void warm_up(const PaceFrames& frames, Processor& processor, const Pipeline::Options& options,
             LatencySink& sink) {
  Replay once(frames, static_cast<std::uint64_t>(options.frames_in_flight));
  Pipeline(once, processor, {&sink}, options).run();
  sink.latencies.clear();
}

std::string warning_of(const char* request, const std::string& refusal) {
  return refusal.empty() ? "" : fmt::format("pillarfield: {}: refused, {}\n", request, refusal);
}

/// Prints refusals, the loaded part of the source, and on a terminal the duration of the run.
void announce(const PaceReport& report, const PaceOptions& options) {
  if (report.realtime) {
    fmt::print(stderr, "{}{}", warning_of("real-time scheduling", report.realtime->scheduling),
               warning_of("locked memory", report.realtime->memory));
  }
  if (report.frames_loaded < std::min(report.frames_in_source, report.schedule.frames)) {
    fmt::print(stderr, "{}: {} of {} frames fit into {} MiB; see --memory-limit\n",
               printable(options.source), report.frames_loaded, report.frames_in_source,
               options.memory_limit_mib);
  }
  if (options.quiet || isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "Pacing for {:g} s at {:g} Hz, {}\n", options.seconds, options.rate_hz,
             report.frames_loaded < report.schedule.frames
                 ? fmt::format("{} frames repeated ...", report.frames_loaded)
                 : "each frame once ...");
}

void print(const PaceReport& report, const PaceOptions& options, const SolverPlan& plan,
           const Processor& processor) {
  if (options.json) {
    print_pace_json(report, plan, processor);
  } else {
    print_pace_text(report, plan, processor);
  }
}

/// Implements --strict.
void require_success(const PaceReport& report) {
  const PaceResult& result = report.result;
  if (result.interrupted) {
    throw Error(report.source,
                fmt::format("interrupted after {} of {} frames", result.scheduled(),
                            report.schedule.frames),
                "start again");
  }
  if (failures(report) == 0) return;
  throw Error(
      report.source,
      fmt::format("{} of {} frames were late or dropped", failures(report), result.scheduled()),
      "give a lower --rate, a longer --deadline or fewer --outputs");
}

}  // namespace

void pace(const PaceOptions& options) {
  PaceReport report;
  report.source = options.source;
  report.schedule = schedule_of(options);
  report.deadline = deadline_of(options);
  PaceFrames frames = open_pace_frames(options.source, frame_options(options.plan));
  const SolverPlan plan = plan_of(options, frames);
  load(frames, report.schedule.frames, options.memory_limit_mib << 20U, options.quiet);
  report.frames_in_source = frames.in_source;
  report.frames_loaded = frames.loaded.size();
  // The device's threads inherit this scheduling; memory is locked once it is allocated.
  if (options.realtime) report.realtime.emplace().scheduling = request_realtime();
  Processor processor(open_device(options.device.name), plan,
                      {.memory = options.device.memory,
                       .frames_in_flight = options.frames_in_flight,
                       .on_compiling = terminal_line(options.quiet)});
  report.frames_in_flight = options.frames_in_flight;
  LatencySink latency_sink(report.schedule.frames);
  const Pipeline::Options run_options = {.frames_in_flight = options.frames_in_flight,
                                         .stop = is_interrupted};
  warm_up(frames, processor, run_options, latency_sink);
  const auto stream = paced(frames, report.schedule);
  Pipeline pipeline(*stream, processor, {&latency_sink}, run_options);
  if (report.realtime) report.realtime->memory = request_locked_memory();
  announce(report, options);

  const ProcessUsage before = process_usage_since();
  const auto start = std::chrono::steady_clock::now();
  const PipelineStatistics done = pipeline.run();
  report.result.elapsed = std::chrono::steady_clock::now() - start;
  report.usage = process_usage_since(before);

  report.result.latencies = std::move(latency_sink.latencies);
  report.result.dropped = done.lost;
  report.result.interrupted = done.stopped;
  report.last_frame.add(latency_sink.status);
  print(report, options, plan, processor);
  if (options.strict) require_success(report);
}

}  // namespace pillarfield::cli
