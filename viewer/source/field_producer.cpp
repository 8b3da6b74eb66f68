#include "viewer/source/field_producer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/recording.h"
#include "pillarfield/scene.h"
#include "pillarfield/simulator.h"
#include "viewer/source/force_file_producer.h"
#include "viewer/source/solved_producer.h"

namespace pillarfield::viewer {
namespace {

/// A survey releases each field at once.
constexpr int kSurveySlots = 2;

Processor processor_for(const Device& device, const SolverPlan& plan,
                        const ProducerOptions& options, int slots = FieldProducer::kMostShown) {
  return {
      device,
      plan,
      {.memory = options.memory, .frames_in_flight = slots, .on_compiling = options.on_compiling}};
}

/// Drops on_compiling, which refers to the caller that is opening the source.
ProducerOptions options_for_later(ProducerOptions options) {
  options.on_compiling = {};
  return options;
}

/// Number of frames to simulate of a scene; adds a warning where it is not all.
std::uint64_t frames_to_simulate(const Simulator& simulator, const ProducerOptions& options,
                                 SourceInfo& info) {
  constexpr std::uint64_t kMiB = 1U << 20U;
  const Scene& scene = simulator.scene();
  const std::uint64_t frame_bytes = scene.skin.sensels() * size_of(simulator.sensel_type());
  const std::uint64_t fitting = options.memory_bytes / frame_bytes;
  if (fitting == 0) {
    throw Error(info.name,
                fmt::format("a frame takes {} bytes, and {} are allowed", frame_bytes,
                            options.memory_bytes),
                "allow more memory");
  }
  std::uint64_t wanted = scene.frames;
  if (options.most_frames > 0) wanted = std::min(wanted, options.most_frames);
  if (fitting < wanted) {
    info.warnings.push_back(
        fmt::format("The first {} of {} frames are shown: more do not fit into "
                    "{} MiB.",
                    fitting, scene.frames, options.memory_bytes / kMiB));
  } else if (wanted < scene.frames) {
    info.notes.push_back(
        fmt::format("The first {} of {} frames are shown, as requested.", wanted, scene.frames));
  }
  return std::min(wanted, fitting);
}

std::unique_ptr<FieldProducer> open_scene(const std::filesystem::path& path,
                                          const ProducerOptions& options,
                                          const std::function<void(double)>& progress) {
  const auto simulator = std::make_shared<const Simulator>(load_scene(path));
  const Scene& scene = simulator->scene();
  SourceInfo info;
  info.name = path.filename().string();
  info.kind = "scene";
  info.rate_hz = scene.rate_hz;
  const std::uint64_t frames = frames_to_simulate(*simulator, options, info);
  if (scene.solver.baseline_time_s) {
    info.notes.emplace_back("The baseline is fixed: frames are solved in any order.");
  }
  SolverPlan plan;
  plan.skin = scene.skin;
  plan.sensel_type = simulator->sensel_type();
  plan.calibration = simulator->calibration();
  set_solver(plan, scene);
  plan = shown_plan(std::move(plan));
  // Before the simulation, so that errors of the device come at once.
  const Device device = open_device(options.device);
  Processor processor = processor_for(device, plan, options);
  describe(info, plan, processor);
  info.solver += processor.shares_memory() ? ", zero copy" : ", staged";
  const std::shared_ptr<FrameProvider> provider = simulate_frames(*simulator, frames, progress);
  info.frames = frames;
  auto producer = std::make_unique<SolvedProducer>(info, provider, plan, std::move(processor));
  producer->open_again = [=, options =
                                 options_for_later(options)]() -> std::unique_ptr<FieldProducer> {
    // Simulated frames may be read by several threads.
    return std::make_unique<SolvedProducer>(info, provider, plan,
                                            processor_for(device, plan, options, kSurveySlots));
  };
  return producer;
}

/// Warnings about the readings of a few frames, solved by `processor`.
std::vector<std::string> reading_warnings(FrameSource& source, const SolverPlan& plan,
                                          Processor& processor) {
  constexpr std::uint64_t kMostFrames = 8;
  const std::uint64_t frames = std::min(kMostFrames, source.frames());
  ReadingCheck check(plan);
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  for (std::uint64_t i = 0; i < frames; ++i) {
    source.read(i * source.frames() / frames, frame);
    processor.submit(frame.view());
    check.append({.forces = processor.receive(), .readings = frame.view()});
  }
  return check.warnings();
}

std::unique_ptr<FieldProducer> open_recording(const std::filesystem::path& path,
                                              const ProducerOptions& options) {
  const ReadOptions read = frame_options(options.plan);
  std::unique_ptr<FrameSource> source = open_frames(path, read);
  if (source->frames() == 0) {
    throw Error(path.string(), "it has no frames", "give a recording with at least one frame");
  }
  SourceInfo info;
  info.name = path.filename().string();
  info.kind = source->format();
  info.warnings = source->warnings();
  info.notes = source->notes();
  SolverPlan plan = plan_of_frames(*source);
  info.rate_hz =
      frame_rate(source->frames(), [&](std::uint64_t index) { return source->time(index); });
  plan.frame_interval_s = 1 / info.rate_hz;
  plan = shown_plan(
      build_plan(std::move(plan), options.plan, path.string(), [&] { return 1 / info.rate_hz; }));
  std::ranges::move(allow_for_errors(plan, *source), std::back_inserter(info.warnings));
  const Device device = open_device(options.device);
  Processor processor = processor_for(device, plan, options);
  describe(info, plan, processor);
  info.solver += processor.shares_memory() ? ", zero copy" : ", staged";
  // Other frames would leave a state in the processor of a calibrated skin.
  if (!source->has_truth() && plan.calibration.empty()) {
    std::ranges::move(reading_warnings(*source, plan, processor),
                      std::back_inserter(info.warnings));
  }
  info.frames = source->frames();
  auto producer = std::make_unique<SolvedProducer>(
      info, recorded_frames(path, std::move(source), read), plan, std::move(processor));
  producer->open_again = [=, options =
                                 options_for_later(options)]() -> std::unique_ptr<FieldProducer> {
    return std::make_unique<SolvedProducer>(
        info, recorded_frames(path, open_frames(path, read), read), plan,
        processor_for(device, plan, options, kSurveySlots));
  };
  return producer;
}

}  // namespace

std::string solver_words(SkinLayout layout, const std::string& estimator,
                         const std::string& device) {
  if (layout == SkinLayout::sensels) return device;
  return device.empty() ? estimator : fmt::format("{} on {}", estimator, device);
}

void throw_all_fields_in_use() {
  throw Error("FieldProducer", fmt::format("all {} fields are in use", FieldProducer::kMostShown),
              "release one before producing another");
}

std::optional<CurvePoint> FieldProducer::stored_total(std::uint64_t /*index*/) {
  return std::nullopt;
}

ShownContacts FieldProducer::contacts_of(const ShownField& field) {
  if (!found_contacts_) found_contacts_.emplace(info().skin.element_pitch_mm(), info().contacts);
  return found_contacts_->contacts_of(field);
}

std::unique_ptr<FieldProducer> open_producer(const std::filesystem::path& path,
                                             const ProducerOptions& options,
                                             const std::function<void(double)>& progress) {
  const ReadOptions& read = options.plan.read;
  const auto refuse_calibration = [&](const char* why) {
    if (!options.plan.calibration.empty())
      throw Error(path.string(), why, "leave out --calibration");
  };
  if (path.extension() == ".toml") {
    refuse_calibration("a scene has a calibration of its own");
    return open_scene(path, options, progress);
  }
  if (read.dataset.empty() && is_force_file(path)) {
    refuse_calibration("it holds forces, which are calibrated already");
    auto producer = std::make_unique<ForceFileProducer>(path, read);
    producer->open_again = [path, read] { return std::make_unique<ForceFileProducer>(path, read); };
    return producer;
  }
  return open_recording(path, options);
}

double frame_rate(std::uint64_t frames, const std::function<double(std::uint64_t)>& time_of) {
  constexpr double kUnknown = 100;
  constexpr std::uint64_t kMostTimes = 8;  // The time of a frame costs reading all of it.
  std::vector<double> steps;
  for (std::uint64_t index = 0; index < std::min(frames, kMostTimes); ++index) {
    const double time_s = time_of(index);
    if (index > 0) steps.back() = time_s - steps.back();
    steps.push_back(time_s);
  }
  if (steps.size() < 2) return kUnknown;
  steps.pop_back();  // Holds the last time, not a step.
  const auto middle = steps.begin() + std::ssize(steps) / 2;
  std::ranges::nth_element(steps, middle);
  const double rate_hz = 1 / *middle;
  return *middle > 0 && std::isfinite(rate_hz) ? rate_hz : kUnknown;
}

}  // namespace pillarfield::viewer
