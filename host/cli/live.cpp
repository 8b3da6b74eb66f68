// pillarfield pace: solves frames at a fixed rate and reports how late their forces are.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/live_frames.h"
#include "cli/live_report.h"
#include "cli/live_run.h"
#include "cli/progress.h"
#include "cli/realtime.h"
#include "pillarfield/error.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

Nanoseconds nanoseconds(double seconds) { return Nanoseconds(std::llround(1e9 * seconds)); }

LiveSchedule schedule_of(const PaceOptions& options) {
  constexpr double kMostFrames = 1e7;  // Each leaves its latency in memory.
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

/// Time goes on where frames come again, so the interval is that of the run, not of the file.
SolverPlan plan_of(const PaceOptions& options, const LiveFrames& live) {
  SolverPlan plan;
  plan.skin = live.skin;
  plan.sensel_type = live.sensel_type;
  plan.calibration = live.calibration;
  PlanOptions asked = options.plan;
  if (is_scene(options.source) && asked.scene.empty()) asked.scene = options.source;
  plan = plan_of(asked, std::move(plan), options.source, [&] { return 1 / options.rate_hz; });
  check(plan, options.source);  // Before frames are loaded, which may take a while.
  return plan;
}

/// Frames in memory, over and over.
class Replay final : public FrameStream {
 public:
  Replay(const LiveFrames& live, std::uint64_t frames) : live_(live), frames_(frames) {}

  [[nodiscard]] const Skin& skin() const override { return live_.skin; }
  [[nodiscard]] SenselType sensel_type() const override { return live_.sensel_type; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, Nanoseconds) override {
    frame.sequence = next_;
    if (next_ == frames_) return Arrival::ended;
    frame.readings = live_.loaded[next_++ % live_.loaded.size()].view();
    return Arrival::arrived;
  }

 private:
  const LiveFrames& live_;
  std::uint64_t frames_;
  std::uint64_t next_ = 0;
};

/// Notes how late forces come. Its memory is taken beforehand.
class Stopwatches final : public ForceSink {
 public:
  explicit Stopwatches(std::uint64_t frames) {
    latencies.resize(frames);  // Touches the pages.
    latencies.clear();
  }
  void append(const SolvedFrame& frame) override {
    latencies.push_back(std::chrono::steady_clock::now().time_since_epoch() - frame.arrived);
    status = frame.forces.status;
  }

  std::vector<Nanoseconds> latencies;
  std::span<const std::uint8_t> status;  ///< of the last frame; stays until one is submitted
};

std::unique_ptr<FrameStream> paced(const LiveFrames& frames, const LiveSchedule& schedule) {
  return paced_stream(
      std::make_unique<Replay>(frames, schedule.frames),
      {.rate_hz = schedule.rate_hz,
       .drop_after = nanoseconds(static_cast<double>(schedule.backlog_frames) / schedule.rate_hz),
       .spin = schedule.spin});
}

/// Solves a frame in every slot: the first result of a slot takes its memory page by page.
void warm_up(const LiveFrames& frames, Processor& processor, const Pipeline::Options& options,
             Stopwatches& sink) {
  Replay once(frames, static_cast<std::uint64_t>(options.frames_in_flight));
  Pipeline(once, processor, {&sink}, options).run();
  sink.latencies.clear();
}

std::string warning_of(const char* what, const std::string& refused) {
  return refused.empty() ? "" : fmt::format("pillarfield: {}: refused, {}\n", what, refused);
}

/// Says what a user may wonder about while nothing else is written.
void announce(const LiveReport& report, const PaceOptions& options) {
  if (report.realtime) {
    fmt::print(stderr, "{}{}",
               warning_of("real-time scheduling", report.realtime->scheduling_refused),
               warning_of("locked memory", report.realtime->memory_refused));
  }
  if (report.frames_loaded < std::min(report.frames_in_source, report.schedule.frames)) {
    fmt::print(stderr, "{}: {} of {} frames fit into {} MiB; see --memory-limit\n",
               printable(options.source), report.frames_loaded, report.frames_in_source,
               options.memory_limit_mib);
  }
  if (options.quiet || isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "Pacing for {:g} s at {:g} Hz, {}\n", options.seconds, options.rate_hz,
             report.frames_loaded < report.schedule.frames
                 ? fmt::format("{} frames over and over ...", report.frames_loaded)
                 : "each frame once ...");
}

void print(const LiveReport& report, const PaceOptions& options, const SolverPlan& plan,
           const Processor& processor) {
  if (options.json) {
    print_live_json(report, plan, processor);
  } else {
    print_live_text(report, plan, processor);
  }
}

/// What --strict asks for.
void require_success(const LiveReport& report) {
  const LiveResult& result = report.result;
  if (result.interrupted) {
    throw Error(report.source,
                fmt::format("interrupted after {} of {} frames", result.scheduled(),
                            report.schedule.frames),
                "start again");
  }
  if (failures(report) == 0) return;
  throw Error(
      report.source,
      fmt::format("{} of {} frames came late or never", failures(report), result.scheduled()),
      "ask for a lower --rate, a later --deadline or fewer outputs");
}

}  // namespace

void pace(const PaceOptions& options) {
  LiveReport report;
  report.source = options.source;
  report.schedule = schedule_of(options);
  report.deadline = deadline_of(options);
  LiveFrames frames = open_live_frames(options.source, options.plan.read);
  const SolverPlan plan = plan_of(options, frames);
  load(frames, report.schedule.frames, options.memory_limit_mib << 20U, options.quiet);
  report.frames_in_source = frames.in_source;
  report.frames_loaded = frames.loaded.size();
  // The device's threads inherit how this one is scheduled; memory is locked once it is there.
  if (options.realtime) report.realtime.emplace().scheduling_refused = ask_for_realtime();
  Processor processor(open_device(options.device.name), plan,
                      {.memory = options.device.memory,
                       .frames_in_flight = options.frames_in_flight,
                       .on_compiling = terminal_line(options.quiet)});
  report.frames_in_flight = options.frames_in_flight;
  Stopwatches stopwatches(report.schedule.frames);
  const Pipeline::Options run_options = {.frames_in_flight = options.frames_in_flight,
                                         .stop = is_interrupted};
  warm_up(frames, processor, run_options, stopwatches);
  const auto stream = paced(frames, report.schedule);
  Pipeline pipeline(*stream, processor, {&stopwatches}, run_options);
  if (report.realtime) report.realtime->memory_refused = ask_for_locked_memory();
  announce(report, options);

  const ProcessUsage before = process_usage();
  const auto start = std::chrono::steady_clock::now();
  const PipelineStatistics done = pipeline.run();
  report.result.elapsed = std::chrono::steady_clock::now() - start;
  report.usage = process_usage_since(before);

  report.result.latencies = std::move(stopwatches.latencies);
  report.result.dropped = done.lost;
  report.result.interrupted = done.stopped;
  report.last_frame.add(stopwatches.status);
  print(report, options, plan, processor);
  if (options.strict) require_success(report);
}

}  // namespace pillarfield::cli
