#include "viewer/source/live_player.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>
#include <utility>

#include "host/io/skin_constants.h"
#include "pillarfield/error.h"
#include "pillarfield/live_session.h"
#include "pillarfield/plan_builder.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/result_player.h"

namespace pillarfield::viewer {
namespace {

using LiveTime = std::chrono::nanoseconds;

constexpr auto kTareTime = std::chrono::milliseconds(500);
/// Time after a refused tare in which the next one is taken as it is.
constexpr LiveTime kInsistTime = std::chrono::seconds(10);
/// Points of the curves of a sensor: two minutes at 1 kHz.
constexpr std::size_t kMostLivePoints = 120'000;

LiveTime live_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

SourceInfo live_info(const std::string& name, const SolverPlan& plan, const Processor& processor) {
  SourceInfo info;
  info.name = name == "-" ? "standard input" : name;
  info.kind = "sensor";
  info.skin = plan.skin;
  info.calibration = plan.calibration;
  info.has_readings = true;
  info.has_angles = plan.angles;
  info.has_uncertainty = plan.uncertainty;
  set_sensor(info.contacts, plan);
  info.solver =
      solver_words(plan.skin.layout, name_of(plan.estimator), processor.device().info().name);
  return info;
}

LiveSinkInfo recording_info(const SourceInfo& source, const SolverPlan& plan) {
  LiveSinkInfo info = live_sink_info(plan, "", source.name);
  info.replace = Replace::nothing;
  return info;
}

/// The readings of a field on display, and its forces where elements without readings were
/// taken out.
struct LiveField {
  explicit LiveField(const SolverPlan& plan)
      : readings(plan.sensel_type, plan.skin.rows, plan.skin.cols) {}
  FrameBuffer readings;
  std::optional<PlaneBlock> planes;
};

/// Keeps the memory of a field alive.
struct LiveFieldOwner {
  explicit LiveFieldOwner(std::shared_ptr<LiveField> kept) : field(std::move(kept)) {}
  std::shared_ptr<LiveField> field;
  std::optional<Processor::PinnedResult> result;  ///< released first: then `field` implies a slot
};

}  // namespace

struct LivePlayer::State final : ForceSink {
  State(std::unique_ptr<FrameStream> from, const std::string& name, SolverPlan with,
        Processor solver, std::shared_ptr<Curves> measured, NewestField& shown, Wanted& asked,
        bool keeps_threshold);
  ~State() override;

  void append(const SolvedFrame& frame) override;

  // Run in the thread.
  void run();
  void run_pipeline();
  [[nodiscard]] ShownField field_of(const SolvedFrame& frame, std::uint64_t index) const;
  void publish(const SolvedFrame& frame);

  void take_events();

  const std::unique_ptr<FrameStream> stream;
  const SolverPlan plan;
  Processor processor;
  SourceInfo info;  ///< of the display's thread
  const std::shared_ptr<Curves> curves;
  LiveSession session;
  // Of the thread.
  FieldClock clock{live_now()};
  ContactTracker tracker;
  PeakHold peak;
  ObjectPool<LiveField> fields;
  bool tracks = false;
  double time_s = 0;  ///< of the frame solved last

  Wanted& wanted;
  std::atomic<bool> stopping = false;
  std::atomic<bool> ended = false;
  std::atomic<std::uint64_t> solved = 0;

  mutable std::mutex mutex;  ///< guards `message` and `messages`
  std::string message;
  std::uint64_t messages = 0;
  LiveTime refused_at = -kInsistTime;  ///< the last tare

  NewestField& newest;
  std::thread thread;  ///< last: uses the other members
};

LivePlayer::State::State(std::unique_ptr<FrameStream> from, const std::string& name,
                         SolverPlan with, Processor solver, std::shared_ptr<Curves> measured,
                         NewestField& shown, Wanted& asked, bool keeps_threshold)
    : stream(std::move(from)),
      plan(std::move(with)),
      processor(std::move(solver)),
      info(live_info(name, plan, processor)),
      curves(std::move(measured)),
      session(*stream, plan, processor, recording_info(info, plan), keeps_threshold),
      tracker(plan.skin.element_pitch_mm(), info.contacts),
      fields(FieldProducer::kMostShown, [this] { return std::make_unique<LiveField>(plan); }),
      wanted(asked),
      newest(shown),
      thread([this] { run(); }) {}

LivePlayer::State::~State() {
  stopping = true;
  thread.join();
  session.finish();
  for (const LiveSession::Sink& sink : session.sinks()) {
    if (sink.statistics.failure.empty()) continue;
    fmt::print(stderr, "pillarfield-viewer: {}\n", sink.statistics.failure);
  }
}

void LivePlayer::State::run() {
  std::exception_ptr failure;
  try {
    while (!stopping && !ended) run_pipeline();
  } catch (...) {
    failure = std::current_exception();
  }
  ended = true;
  newest.end(failure);
}

/// Runs until the player ends, or contacts are switched.
void LivePlayer::State::run_pipeline() {
  tracks = wanted.contacts;
  if (tracks) tracker = ContactTracker(plan.skin.element_pitch_mm(), tracker.options());
  const PipelineStatistics done =
      session.run({.contacts = tracks ? &tracker : nullptr, .sink = this, .stop = [this] {
                     return stopping || tracks != wanted.contacts;
                   }});
  ended = !done.stopped;
}

std::string words_of(const LiveEvent& event) {
  if (event.kind == LiveEvent::Kind::recording) {
    return fmt::format("recorded {}: {}", recorded_words(event.recorded), event.recording);
  }
  if (!event.error.empty()) return event.error + "; press it again within 10 s to insist";
  return fmt::format("tare taken: {}{}", event.note,
                     event.recording.empty() ? "" : "; the recording keeps that of its start");
}

void LivePlayer::State::take_events() {
  for (const LiveEvent& event : session.take_events()) {
    message = words_of(event);
    ++messages;
    if (event.kind != LiveEvent::Kind::tare) continue;
    if (!event.error.empty()) refused_at = live_now();
    const LiveSinkInfo now = session.info();
    info.skin = now.skin;
    info.calibration = now.calibration;
  }
}

ShownField LivePlayer::State::field_of(const SolvedFrame& frame, std::uint64_t index) const {
  ShownField field;
  field.forces = frame.forces;
  field.raw = frame.readings;
  field.time_s = time_s;
  field.index = index;
  field.arrived = frame.arrived;
  if (plan.estimator == Estimator::direct) field.direct_point = plan.segment_point;
  field.shear_coefficient = plan.calibration.effects.shear_coefficient.value_or(ShearCoefficient{});
  return field;
}

void LivePlayer::State::append(const SolvedFrame& frame) {
  time_s = clock.time_s(frame.time_s, frame.arrived);
  curves->add(field_of(frame, solved));
  if (wanted.peak) {
    if (wanted.peak_anew.exchange(false)) peak.reset();
    peak.add(frame.forces);
  }
  newest.count(frame.arrived);
  ++solved;
  if (!wanted.paused) publish(frame);
}

/// Hands the frame solved last to the display: its forces in place, its readings copied.
void LivePlayer::State::publish(const SolvedFrame& frame) {
  const auto owner = std::make_shared<LiveFieldOwner>(fields.acquire());
  if (owner->field == nullptr) return;
  copy_readings(frame.readings, owner->field->readings.bytes().data());
  ShownField field = field_of(frame, solved - 1);
  field.raw = owner->field->readings.view();
  if (frame.missing.empty()) {
    owner->result = processor.pin();
    field.pages = owner->result->pages();
  } else {
    std::optional<PlaneBlock>& planes = owner->field->planes;
    if (!planes)
      planes.emplace(plan.skin.layout, frame.forces.rows, frame.forces.cols, plan.uncertainty);
    planes->copy(frame.forces);
    field.forces = planes->view();
    field.pages = planes->pages();
  }
  field.keep_alive = owner;
  if (tracks) {
    field.contacts = std::make_shared<const ShownContacts>(
        with_extents(*frame.contacts, tracker.labels(), tracker.options().noise_n));
  }
  if (wanted.peak) field.peak = peak.field(field);
  newest.set(std::move(field));
}

LivePlayer::LivePlayer(std::unique_ptr<FrameStream> stream, const std::string& name,
                       const SolverPlan& plan, Processor processor, std::shared_ptr<Curves> curves,
                       bool keeps_threshold)
    : state_(std::make_unique<State>(std::move(stream), name, plan, std::move(processor),
                                     std::move(curves), newest_, wanted_, keeps_threshold)) {}

LivePlayer::~LivePlayer() = default;

const SourceInfo& LivePlayer::info() const { return state_->info; }

PlayerState LivePlayer::state() const {
  return state_after(state_->solved, state_->session.health().stream.rate_hz);
}

void LivePlayer::tare() {
  const std::scoped_lock lock(state_->mutex);
  state_->session.start_tare(kTareTime, live_now() - state_->refused_at < kInsistTime);
}

void LivePlayer::record(const std::filesystem::path& path) {
  stop_recording();
  state_->session.record(path);
}

void LivePlayer::stop_recording() { state_->session.stop_recording(); }

std::string recorded_words(const LiveSinkStatistics& recorded) {
  std::string words = fmt::format("{} frames", recorded.frames);
  if (recorded.dropped > 0) words += fmt::format(", {} dropped", recorded.dropped);
  if (!recorded.failure.empty()) words += ", failed: " + recorded.failure;
  return words;
}

LiveStatus LivePlayer::status() const {
  LiveSession& session = state_->session;
  LiveStatus status;
  status.health = session.health();
  status.health.solved = state_->solved;  // and on display
  status.ended = state_->ended;
  status.taring = session.is_taring();
  status.recording = session.recording();
  for (const LiveSession::Sink& sink : session.sinks()) status.recorded = sink.statistics;
  const std::scoped_lock lock(state_->mutex);
  state_->take_events();
  status.message = state_->message;
  status.messages = state_->messages;
  return status;
}

namespace {

PlanOptions plan_options(const LiveOptions& options) {
  return {.read = options.producer.read, .calibration = options.calibration.string()};
}

OpenedSensor open_results(std::unique_ptr<ResultStream> results, const std::string& source,
                          const LiveOptions& options) {
  std::vector<std::string> given = given_constants(options.producer.read);
  if (!options.calibration.empty()) given.emplace_back("--calibration");
  if (!given.empty()) {
    throw Error(source, "it holds results, which are calibrated already",
                fmt::format("leave out {}", fmt::join(given, ", ")));
  }
  OpenedSensor opened;
  opened.curves = std::make_shared<Curves>(results->skin().element_pitch_mm(), kMostLivePoints);
  opened.player = std::make_unique<ResultPlayer>(std::move(results), source, opened.curves);
  return opened;
}

}  // namespace

SolverPlan live_plan(const FrameStream& stream, const LiveOptions& options) {
  SolverPlan plan =
      build_plan(plan_of_frames(stream), plan_options(options), options.calibration.string(),
                 [&] { return SolverPlan{}.frame_interval_s; });
  if (plan.calibration.tare.empty()) plan.calibration.tare.assign(plan.skin.sensels(), 0);
  plan.angles = plan.skin.has_pillars();
  plan.uncertainty = plan.noise_counts.has_value() || !plan.calibration.noise.empty();
  return plan;
}

OpenedSensor open_sensor(const std::string& source, const LiveOptions& options) {
  LiveSourceOptions live;
  live.stop = options.stop;
  live.say = options.say;
  live.size = stated_size(plan_options(options));
  live.read = options.producer.read;
  if (source.starts_with("shm:")) {
    if (auto results = open_result_stream(source, options.stop)) {
      return open_results(std::move(results), source, options);
    }
  }
  std::unique_ptr<FrameStream> stream = open_live_source(source, live);
  if (stream == nullptr) return {};
  const SolverPlan plan = live_plan(*stream, options);
  Processor processor(open_device(options.producer.device), plan,
                      {.memory = options.producer.memory,
                       .frames_in_flight = LivePlayer::kFramesInFlight,
                       .on_compiling = options.producer.on_compiling});
  OpenedSensor opened;
  opened.curves = std::make_shared<Curves>(plan.skin.element_pitch_mm(), kMostLivePoints);
  opened.player = std::make_unique<LivePlayer>(std::move(stream), source, plan,
                                               std::move(processor), opened.curves,
                                               options.producer.read.threshold_counts.has_value());
  return opened;
}

}  // namespace pillarfield::viewer
