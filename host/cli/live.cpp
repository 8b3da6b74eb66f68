// pillarfield live: frames at a fixed rate, and how late their forces come.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "cli/command.h"
#include "cli/device_options.h"
#include "cli/interrupt.h"
#include "cli/live_frames.h"
#include "cli/live_report.h"
#include "cli/live_run.h"
#include "cli/number_range.h"
#include "cli/plan_options.h"
#include "cli/progress.h"
#include "cli/realtime.h"
#include "pillarfield/error.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

struct LiveOptions {
  std::string source;
  double rate_hz = 1000;
  double seconds = 10;
  std::optional<double> deadline_ms;
  std::uint64_t backlog_frames = 4;
  int frames_in_flight = 2;
  double spin_us = 0;
  std::uint64_t memory_limit_mib = 1024;
  bool half = false;
  bool realtime = false;
  bool strict = false;
  PlanOptions plan;
  DeviceOptions device;
  bool json = false;
  bool quiet = false;
};

void require_between(const char* option, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Error(option, fmt::format("{:g} is out of range", value),
              fmt::format("give {:g} to {:g}", least, most));
}

Nanoseconds nanoseconds(double seconds) { return Nanoseconds(std::llround(1e9 * seconds)); }

LiveSchedule schedule_of(const LiveOptions& options) {
  constexpr double kMostFrames = 1e7;  // Each leaves its latency in memory.
  require_between("--rate", options.rate_hz, 0.01, 1e5);
  require_between("--seconds", options.seconds, 0.5 / options.rate_hz,
                  kMostFrames / options.rate_hz);
  require_between("--spin", options.spin_us, 0, 1e6);
  return {.rate_hz = options.rate_hz,
          .frames = static_cast<std::uint64_t>(std::llround(options.rate_hz * options.seconds)),
          .backlog_frames = options.backlog_frames,
          .spin = nanoseconds(1e-6 * options.spin_us)};
}

Nanoseconds deadline_of(const LiveOptions& options) {
  const double deadline_ms = options.deadline_ms.value_or(1e3 / options.rate_hz);
  require_between("--deadline", deadline_ms, 1e-3, 1e6);
  return nanoseconds(1e-3 * deadline_ms);
}

/// Time goes on where frames come again, so the interval is that of the run, not of the file.
SolverPlan plan_of(const LiveOptions& options, const LiveFrames& live) {
  SolverPlan plan;
  plan.skin = live.skin;
  plan.sensel_type = live.sensel_type;
  plan.calibration = live.calibration;
  PlanOptions asked = options.plan;
  if (is_scene(options.source) && asked.scene.empty()) asked.scene = options.source;
  plan = plan_of(asked, std::move(plan), options.source, [&] { return 1 / options.rate_hz; });
  plan.half_output = options.half;
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

std::string remark_on(const char* what, const std::string& refused) {
  return refused.empty() ? "" : fmt::format("pillarfield: {}: refused, {}\n", what, refused);
}

/// Says what a user may wonder about while nothing else is written.
void announce(const LiveReport& report, const LiveOptions& options) {
  if (report.realtime) {
    fmt::print(stderr, "{}{}",
               remark_on("real-time scheduling", report.realtime->scheduling_refused),
               remark_on("locked memory", report.realtime->memory_refused));
  }
  if (report.frames_loaded < std::min(report.frames_in_source, report.schedule.frames)) {
    fmt::print(stderr, "{}: {} of {} frames fit into {} MiB; see --memory-limit\n",
               printable(options.source), report.frames_loaded, report.frames_in_source,
               options.memory_limit_mib);
  }
  if (options.quiet || isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "Live for {:g} s at {:g} Hz, {}\n", options.seconds, options.rate_hz,
             report.frames_loaded < report.schedule.frames
                 ? fmt::format("{} frames over and over ...", report.frames_loaded)
                 : "each frame once ...");
}

void print(const LiveReport& report, const LiveOptions& options, const SolverPlan& plan,
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

void live(const LiveOptions& options) {
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
                                         .stop = is_interrupted,
                                         .half_output = options.half};
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

void add_run_options(CLI::App& command, LiveOptions& options) {
  command.add_option("--rate", options.rate_hz, "Frames per second [1000]");
  command.add_option("--seconds", options.seconds, "How long the run lasts [10]");
  command.add_option("--deadline", options.deadline_ms,
                     "Milliseconds from when a frame is due until its forces must be there "
                     "[one period]");
  command
      .add_option("--backlog", options.backlog_frames,
                  "Drop a frame whose turn comes more than so many frames late [4]")
      ->check(whole_number_range(0, 1000));
  command
      .add_option("--in-flight", options.frames_in_flight,
                  "While the solver is late, start so many frames before the first is done [2]")
      ->check(whole_number_range(1, 64));
  command.add_option("--spin", options.spin_us,
                     "Of each wait, spend the last so many microseconds spinning [0]");
  command
      .add_option("--memory-limit", options.memory_limit_mib,
                  "Frames are loaded beforehand, into so many MiB at most [1024]")
      ->check(whole_number_range(1, 1U << 20U));
  command.add_flag(
      "--half", options.half,
      "Forces of half precision, which take fewer bytes to memory; not with --estimator contact");
  command.add_flag("--realtime", options.realtime,
                   "Ask for real-time scheduling and locked memory; says so where refused");
  command.add_flag("--strict", options.strict,
                   "Fail where a frame was dropped, missed its deadline, or the run was cut short");
}

}  // namespace

void add_live(CLI::App& app, Work& work) {
  const auto options = std::make_shared<LiveOptions>();
  CLI::App* const command = app.add_subcommand(
      "live", "Solve frames at a fixed rate, and tell how late their forces come");
  command
      ->add_option("SOURCE", options->source,
                   "Scene (TOML), recording (HDF5) or Tekscan ASCII export, replayed from memory")
      ->required();
  add_run_options(*command, *options);
  add_plan_options(*command, options->plan);
  add_device_options(*command, options->device);
  command->add_flag("--json", options->json, "Print the report as JSON");
  command->add_flag("-q,--quiet", options->quiet, "Show no progress");
  command->callback([options, &work] { work = [options] { live(*options); }; });
}

}  // namespace pillarfield::cli
