// pillarfield stream: forces of live frames.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <optional>

#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/stream/replay.h"
#include "cli/stream/session.h"
#include "cli/warnings.h"
#include "io/file_kind.h"
#include "pillarfield/error.h"
#include "pillarfield/layout_note.h"
#include "pillarfield/live.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

std::unique_ptr<FrameStream> opened_source(const StreamOptions& options) {
  if (!is_live_source(options.source)) {
    if (options.newest) {
      throw Error("--newest", "it is for live sources, and this is a file",
                  "leave it out; --summary drops the late frames of a file");
    }
    return replayed_file(options.source, frame_options(options.plan), options.rate_hz,
                         options.repeat, options.summary, options.quiet);
  }
  if (!options.quiet) {
    const bool is_input = options.source == "-";
    fmt::print(stderr, "Waiting for frames from {}\n",
               is_input ? "standard input" : printable(options.source));
  }
  LiveSourceOptions live;
  live.stop = is_interrupted;
  live.serial_baud = options.serial_baud;
  live.newest = options.newest;
  if (options.seconds || options.most_idle_s) {
    live.most_wait =
        nanoseconds_of(std::min(options.seconds.value_or(1e9), options.most_idle_s.value_or(1e9)));
  }
  live.size = stated_size(options.plan);
  live.read = options.plan.read;
  live.say = [&](const std::string& words) {
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(options.source), words);
  };
  return open_live_source(options.source, live);
}

/// Throws Error if a file that is written is one that is read, or may not be replaced.
void check_files(const StreamOptions& options) {
  std::vector<PlannedOutput> outputs;
  if (!options.relay.empty()) check_live_relay(options.relay);
  for (const std::string& sink : options.sinks) {
    check_live_sink(sink);
    const std::string ending = extension_of(sink);
    if (ending == ".mcap") outputs.push_back({sink, OutputKind::messages});
    if (ending == ".h5" || ending == ".hdf5" || ending == ".csv" || ending == ".npy") {
      outputs.push_back(planned_force_file(sink));
    }
  }
  if (!options.record.empty()) outputs.push_back({options.record, OutputKind::recording});
  check_outputs(files_read(options), outputs, options.replace);
}

/// The plan has a tare, so that it can be measured again. Without sinks, which alone take them, a
/// scene's angles and uncertainty are computed only where the command line asks for them.
SolverPlan plan_of(const StreamOptions& options, const FrameStream& source) {
  SolverPlan plan = cli::plan_of(options.plan, plan_of_frames(source), options.source, [&] {
    if (options.rate_hz) return 1 / *options.rate_hz;
    throw Error("--rate", "--follow-baseline and creep need the rate of the sensor",
                "give --rate HZ");
  });
  if (plan.calibration.tare.empty()) plan.calibration.tare.assign(plan.skin.sensels(), 0);
  if (const PlanSettings& asked = options.plan.settings;
      options.sinks.empty() && !asked.everything) {
    plan.angles = asked.angles.value_or(false);
    plan.uncertainty = asked.uncertainty.value_or(false);
  }
  check(plan, options.source);
  return plan;
}

/// Tells which constants of a sensor are assumed.
void tell_assumptions(const StreamOptions& options, const FrameStream& source, const Skin& skin) {
  const std::string note = assumption_note(skin);
  if (options.quiet || note.empty() || !is_live_source(options.source)) return;
  print_about(options.source, "note",
              {fmt::format("Read frames of {} x {}, {}; {}", skin.rows, skin.cols,
                           name_of(source.sensel_type()), note)});
}

LiveSinkInfo sink_info(const StreamOptions& options, const SolverPlan& plan, const Device& device) {
  LiveSinkInfo info = live_sink_info(plan, device.info().name, options.source, options.contacts);
  info.replace = options.replace;
  info.allowed_origins = options.allowed_origins;
  return info;
}

}  // namespace

std::vector<std::filesystem::path> files_read(const StreamOptions& options) {
  std::vector<std::filesystem::path> files = {options.plan.scene, options.plan.calibration};
  if (!is_live_source(options.source)) files.emplace_back(options.source);
  return files;
}

void stream(const StreamOptions& options) {
  // A reader of standard output that ends, as `head` does, must not end the recording.
  std::signal(SIGPIPE, SIG_IGN);
  check_files(options);
  const auto began = std::chrono::steady_clock::now();
  const std::unique_ptr<FrameStream> source = opened_source(options);
  const auto waited = std::chrono::steady_clock::now() - began;
  if (!source) return;  // Interrupted before a frame came.
  const SolverPlan plan = plan_of(options, *source);
  tell_assumptions(options, *source, plan.skin);
  const Device device = open_device(options.device).for_plan(plan);
  Processor processor(
      device, plan,
      {.frames_in_flight = options.frames_in_flight, .on_compiling = terminal_line(options.quiet)});
  StreamSession session(options, *source, plan, processor, sink_info(options, plan, device));
  session.run(is_live_source(options.source) ? waited : std::chrono::nanoseconds(0));
  session.print_summary();
}

}  // namespace pillarfield::cli
