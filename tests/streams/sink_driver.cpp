// Solves the frames of a scene, and passes them to live sinks. The same frames go into a force file
// directly, so that tests can compare what the sinks wrote and sent.

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/live.h"
#include "pillarfield/printable.h"
#include "pillarfield/simulator.h"
#include "streams/sink/frame_copy.h"

namespace pillarfield {
namespace {

constexpr const char* kUsage =
    "sink_driver SCENE [--frames N] [--rate HZ] [--reference FORCES.h5] [--to TARGET]...\n"
    "            [--record FILE.h5] [--wait-for-clients N] [--settle SECONDS] [--linger SECONDS] "
    "[--no-contacts]\n"
    "            [--normal-only]\n";

struct DriverOptions {
  std::string scene;
  std::uint64_t frames = 0;  // 0: those of the scene
  double rate_hz = 1000;
  std::string reference;
  std::string record;
  std::vector<std::string> targets;
  std::uint64_t clients = 0;
  double settle_s = 0;  // before the first frame
  double linger_s = 0;  // before the sinks finish
  bool contacts = true;
  bool normal_only = false;  // sinks get no shear
};

DriverOptions options_of(const std::vector<std::string>& words) {
  DriverOptions options;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    const auto value = [&] { return i + 1 < words.size() ? words[++i] : std::string(); };
    if (word == "--frames")
      options.frames = std::stoull(value());
    else if (word == "--rate")
      options.rate_hz = std::stod(value());
    else if (word == "--reference")
      options.reference = value();
    else if (word == "--record")
      options.record = value();
    else if (word == "--to")
      options.targets.push_back(value());
    else if (word == "--wait-for-clients")
      options.clients = std::stoull(value());
    else if (word == "--settle")
      options.settle_s = std::stod(value());
    else if (word == "--linger")
      options.linger_s = std::stod(value());
    else if (word == "--no-contacts")
      options.contacts = false;
    else if (word == "--normal-only")
      options.normal_only = true;
    else
      options.scene = word;
  }
  return options;
}

/// The solved frames of a scene.
struct Recording {
  LiveSinkInfo info;
  std::vector<FrameCopy> frames;
};

Recording record(const DriverOptions& options) {
  const Scene scene = load_scene(options.scene);
  const Simulator simulator(scene);
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.skin.surface = surface_of(scene);
  plan.sensel_type = simulator.sensel_type();
  plan.calibration = simulator.calibration();
  set_solver(plan, scene);
  ContactOptions contact_options;
  contact_options.minimum_pillars = 4;
  contact_options.surface = plan.skin.surface;
  ContactTracker tracker(plan.skin.pillar_pitch_mm(), contact_options);

  Recording recording;
  recording.info.skin = plan.skin;
  recording.info.sensel_type = plan.sensel_type;
  recording.info.calibration = plan.calibration;
  ForceFileInfo& info = recording.info.forces;
  info = {.rows = plan.skin.pillar_rows(),
          .cols = plan.skin.pillar_cols(),
          .element_pitch_mm = plan.skin.pillar_pitch_mm(),
          .estimator = name_of(estimator_of(plan)),
          .device = "host",
          .source = "a scene",
          .uncertainty = plan.uncertainty,
          .surface = plan.skin.surface};
  if (options.contacts) info.contacts = contact_options;

  FrameBuffer raw(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(info.rows, info.cols);
  recording.frames = std::vector<FrameCopy>(scene.frames);
  for (std::uint32_t index = 0; index < scene.frames; ++index) {
    simulator.render(index, raw, truth);
    const ForceField forces = solve_on_host(plan, raw.view());
    SolvedFrame frame;
    frame.forces = forces.view();
    if (options.contacts) frame.contacts = &tracker.update(frame.forces, simulator.time_of(index));
    frame.readings = raw.view();
    recording.frames[index].assign(
        frame, {.forces = true, .all_planes = true, .contacts = true, .readings = true});
  }
  return recording;
}

void wait_for_clients(const std::vector<std::unique_ptr<LiveSink>>& sinks, std::uint64_t wanted) {
  const auto connected = [&] {
    std::uint64_t clients = 0;
    for (const auto& sink : sinks) clients += sink->statistics().clients;
    return clients;
  };
  while (connected() < wanted) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

void print(const LiveSink& sink) {
  const LiveSinkStatistics done = sink.statistics();
  fmt::print(
      "{{\"name\":\"{}\",\"frames\":{},\"dropped\":{},\"clients\":{},\"refused\":{},"
      "\"failure\":\"{}\"}}\n",
      printable(sink.name()), done.frames, done.dropped, done.clients, done.refused,
      printable(done.failure));
}

void run(const DriverOptions& options) {
  const Recording recording = record(options);
  std::vector<std::unique_ptr<LiveSink>> sinks;
  for (const std::string& target : options.targets) {
    sinks.push_back(create_live_sink(target, recording.info));
  }
  if (!options.record.empty()) {
    sinks.push_back(create_live_recording(options.record, recording.info));
  }
  std::unique_ptr<ForceSink> reference;
  if (!options.reference.empty()) {
    reference = create_force_sink(options.reference, recording.info.forces);
  }
  fmt::print("ready");
  for (const auto& sink : sinks) fmt::print(" {}", sink->name());
  fmt::print("\n");
  std::fflush(stdout);
  wait_for_clients(sinks, options.clients);
  std::this_thread::sleep_for(std::chrono::duration<double>(options.settle_s));

  const std::uint64_t frames = options.frames > 0 ? options.frames : recording.frames.size();
  const auto start = std::chrono::steady_clock::now();
  HealthReport health;
  for (std::uint64_t index = 0; index < frames; ++index) {
    const double time_s = static_cast<double>(index) / options.rate_hz;
    std::this_thread::sleep_until(start + std::chrono::duration<double>(time_s));
    SolvedFrame frame = recording.frames[index % recording.frames.size()].frame();
    frame.time_s = time_s;
    frame.sequence = index;
    frame.arrived = std::chrono::steady_clock::now().time_since_epoch();
    if (reference) reference->append(frame);
    if (options.normal_only) frame.forces.shear_x = frame.forces.shear_y = {};
    for (const auto& sink : sinks) sink->append(frame);
    health.solved = health.stream.frames = index + 1;
    if (index % 10 != 9) continue;
    for (const auto& sink : sinks) sink->report(health);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(options.linger_s));
  for (const auto& sink : sinks) {
    sink->finish();
    print(*sink);
  }
  if (reference) reference->finish();
}

}  // namespace
}  // namespace pillarfield

int main(int count, char** words) {
  if (count < 2) {
    std::fputs(pillarfield::kUsage, stderr);
    return 2;
  }
  try {
    pillarfield::run(pillarfield::options_of({words + 1, words + count}));
  } catch (const std::exception& error) {
    fmt::print(stderr, "sink_driver: {}\n", error.what());
    return 1;
  }
  return 0;
}
