#include "viewer/source/live_player.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/live_session.h"
#include "pillarfield/plan_builder.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/solved_producer.h"

namespace pillarfield::viewer {
double FieldClock::time_s(double sensor_s, std::chrono::nanoseconds arrived) {
  constexpr double kMostApartS = 5;
  constexpr double kLeastStepS = 1e-6;
  const double arrived_s = std::chrono::duration<double>(arrived - start_).count();
  const double by_sensor_s = sensor_s + offset_s_.value_or(arrived_s - sensor_s);
  const bool follows =
      offset_s_ && by_sensor_s > last_s_ && std::abs(by_sensor_s - arrived_s) < kMostApartS;
  last_s_ = follows ? by_sensor_s : std::max(arrived_s, last_s_ + kLeastStepS);
  offset_s_ = last_s_ - sensor_s;
  return last_s_;
}

PlayerState LiveView::state_after(std::uint64_t frames, double rate_hz) const {
  return {.frame = frames,
          .frames = 0,
          .playing = !paused_,
          .loops = false,
          .follows = true,
          .speed = 1,
          .rate_hz = rate_hz};
}

void LiveView::measure(const ShownField& field) {
  curves_->add(field);
  newest_.count();
}

namespace {

using LiveTime = std::chrono::nanoseconds;

constexpr auto kTareTime = std::chrono::milliseconds(500);
/// Time after a refused tare in which the next one is taken as it is.
constexpr LiveTime kInsistTime = std::chrono::seconds(10);
/// Points of the curves of a sensor: two minutes at 1 kHz.
constexpr std::size_t kMostLivePoints = 120'000;
/// Frames in flight of the processor: two, and the fields that the display holds in place.
constexpr int kFramesInFlight = FieldProducer::kMostShown + 2;

LiveTime live_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

SourceInfo live_info(const std::string& name, const SolverPlan& plan, const Processor& processor) {
  SourceInfo info;
  info.name = name == "-" ? "standard input" : name;
  info.kind = "sensor";
  describe(info, plan, processor);
  return info;
}

LiveSinkInfo recording_info(const SourceInfo& source, const SolverPlan& plan) {
  LiveSinkInfo info = live_sink_info(plan, "", source.name);
  info.replace = Replace::nothing;
  return info;
}

std::string words_of(const LiveEvent& event) {
  if (event.kind == LiveEvent::Kind::recording) {
    return fmt::format("recorded {}: {}", recorded_words(event.recorded), event.recording);
  }
  if (!event.error.empty()) {
    // The remedy of the error is that of other doors.
    std::string_view why = event.error;
    why = why.substr(0, why.rfind("; "));
    if (why.starts_with("tare: ")) why.remove_prefix(6);
    return fmt::format(
        "Tare refused: let go of the skin and press Tare again, within 10 s to "
        "insist. {}",
        why);
  }
  return fmt::format("tare taken: {}{}", event.note,
                     event.recording.empty() ? "" : "; the recording keeps that of its start");
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

class LivePlayer final : public LiveView, private ForceSink {
 public:
  LivePlayer(std::unique_ptr<FrameStream> stream, const std::string& name, SolverPlan plan,
             Processor processor, std::shared_ptr<Curves> curves, bool keeps_threshold)
      : LiveView(std::move(curves)),
        stream_(std::move(stream)),
        plan_(std::move(plan)),
        processor_(std::move(processor)),
        info_(live_info(name, plan_, processor_)),
        session_(*stream_, plan_, processor_, recording_info(info_, plan_), keeps_threshold),
        tracker_(plan_.skin.element_pitch_mm(), info_.contacts),
        fields_(FieldProducer::kMostShown, [this] { return std::make_unique<LiveField>(plan_); }),
        thread_([this] { run(); }) {}
  ~LivePlayer() override;

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] PlayerState state() const override {
    return state_after(solved_, session_.health().stream.rate_hz);
  }
  void tare() override {
    const std::scoped_lock lock(mutex_);
    session_.start_tare(kTareTime, live_now() - refused_at_ < kInsistTime);
  }
  void record(const std::filesystem::path& path) override {
    stop_recording();
    session_.record(path);
  }
  void stop_recording() override { session_.stop_recording(); }
  [[nodiscard]] LiveStatus status() override;

 private:
  void take_events();

  // Run in the thread.
  void run();
  void run_pipeline();
  void append(const SolvedFrame& frame) override;
  void publish(const SolvedFrame& frame, ShownField field);

  const std::unique_ptr<FrameStream> stream_;
  const SolverPlan plan_;
  Processor processor_;
  SourceInfo info_;  ///< of the display's thread
  LiveSession session_;
  // Members of the thread.
  ContactTracker tracker_;
  ObjectPool<LiveField> fields_;
  bool tracks_ = false;

  std::atomic<bool> stopping_ = false;
  std::atomic<bool> ended_ = false;
  std::atomic<std::uint64_t> solved_ = 0;

  std::mutex mutex_;                    ///< guards the next two members
  LiveStatus told_;                     ///< messages and their counts
  LiveTime refused_at_ = -kInsistTime;  ///< the last tare

  std::thread thread_;  ///< last: uses the other members
};

LivePlayer::~LivePlayer() {
  stopping_ = true;
  thread_.join();
  session_.finish();
  for (const LiveSession::Sink& sink : session_.sinks()) {
    if (sink.statistics.failure.empty()) continue;
    fmt::print(stderr, "pillarfield-viewer: {}\n", sink.statistics.failure);
  }
}

void LivePlayer::run() {
  std::exception_ptr failure;
  try {
    while (!stopping_ && !ended_) run_pipeline();
  } catch (...) {
    failure = std::current_exception();
  }
  ended_ = true;
  newest_.end(failure);
}

/// Runs until the player ends, or contacts are switched.
void LivePlayer::run_pipeline() {
  tracks_ = wants_contacts_;
  if (tracks_) tracker_ = ContactTracker(plan_.skin.element_pitch_mm(), tracker_.options());
  const PipelineStatistics done =
      session_.run({.contacts = tracks_ ? &tracker_ : nullptr, .sink = this, .stop = [this] {
                      return stopping_ || tracks_ != wants_contacts_;
                    }});
  ended_ = !done.stopped;
}

void LivePlayer::append(const SolvedFrame& frame) {
  ShownField field;
  field.forces = frame.forces;
  field.raw = frame.readings;
  field.time_s = clock_.time_s(frame.time_s, frame.arrived);
  field.index = solved_;
  field.arrived = frame.arrived;
  if (plan_.estimator == Estimator::direct) field.direct_point = plan_.segment_point;
  field.shear_coefficient =
      plan_.calibration.effects.shear_coefficient.value_or(ShearCoefficient{});
  measure(field);
  ++solved_;
  if (!paused_) publish(frame, std::move(field));
}

/// Hands the frame solved last to the display: its forces in place, its readings copied.
void LivePlayer::publish(const SolvedFrame& frame, ShownField field) {
  const auto owner = std::make_shared<LiveFieldOwner>(fields_.acquire());
  if (owner->field == nullptr) return;
  copy_readings(frame.readings, owner->field->readings.bytes().data());
  field.raw = owner->field->readings.view();
  if (frame.missing.empty()) {
    owner->result = processor_.pin();
    field.pages = owner->result->pages();
  } else {
    std::optional<PlaneBlock>& planes = owner->field->planes;
    if (!planes)
      planes.emplace(plan_.skin.layout, frame.forces.rows, frame.forces.cols, plan_.uncertainty);
    planes->copy(frame.forces);
    field.forces = planes->view();
    field.pages = planes->pages();
  }
  field.keep_alive = owner;
  if (tracks_) {
    field.contacts =
        std::make_shared<const ShownContacts>(with_extents(*frame.contacts, tracker_.labels()));
  }
  newest_.set(std::move(field));
}

void LivePlayer::take_events() {
  for (const LiveEvent& event : session_.take_events()) {
    told_.message = words_of(event);
    told_.failed = !event.error.empty() || !event.recorded.failure.empty();
    ++told_.messages;
    if (event.kind != LiveEvent::Kind::tare) continue;
    if (told_.failed) {
      refused_at_ = live_now();
    } else {
      ++told_.tares;
    }
    const LiveSinkInfo now = session_.info();
    info_.skin = now.skin;
    info_.calibration = now.calibration;
  }
}

LiveStatus LivePlayer::status() {
  const std::scoped_lock lock(mutex_);
  take_events();
  LiveStatus status = told_;
  status.health = session_.health();
  status.health.solved = solved_;  // and on display
  status.ended = ended_;
  status.taring = session_.is_taring();
  status.recording = session_.recording();
  for (const LiveSession::Sink& sink : session_.sinks()) status.recorded = sink.statistics;
  return status;
}

/// Options that calibrate, as the command line names them.
std::vector<std::string> given_constants(const LiveOptions& options) {
  const ReadOptions& read = options.producer.plan.read;
  std::vector<std::string> given;
  for (const auto& [name, is_given] :
       {std::pair("--layout", read.layout.has_value()),
        std::pair("--pitch-mm", read.sensel_pitch_mm.has_value()),
        std::pair("--counts-per-newton", read.counts_per_newton.has_value()),
        std::pair("--threshold", read.threshold_counts.has_value()),
        std::pair("--full-scale", read.full_scale_counts.has_value()),
        std::pair("--falling", read.falling),
        std::pair("--calibration", !options.producer.plan.calibration.empty())}) {
    if (is_given) given.emplace_back(name);
  }
  return given;
}

OpenedSensor open_results(std::unique_ptr<ResultStream> results, const std::string& source,
                          const LiveOptions& options) {
  if (const std::vector<std::string> given = given_constants(options); !given.empty()) {
    throw Error(source, "it holds results, which are calibrated already",
                fmt::format("leave out {}", fmt::join(given, ", ")));
  }
  auto curves = std::make_shared<Curves>(results->skin().element_pitch_mm(), kMostLivePoints);
  return {play_results(std::move(results), source, curves), curves};
}

}  // namespace

std::string recorded_words(const LiveSinkStatistics& recorded) {
  std::string words = fmt::format("{} frames", recorded.frames);
  if (recorded.dropped > 0) words += fmt::format(", {} dropped", recorded.dropped);
  if (!recorded.failure.empty()) words += ", failed: " + recorded.failure;
  return words;
}

SolverPlan live_plan(const FrameStream& stream, const LiveOptions& options) {
  SolverPlan plan =
      build_plan(plan_of_frames(stream), options.producer.plan, options.producer.plan.calibration,
                 [&] { return SolverPlan{}.frame_interval_s; });
  if (plan.calibration.tare.empty()) plan.calibration.tare.assign(plan.skin.sensels(), 0);
  plan.angles = plan.skin.has_pillars();
  plan.uncertainty = plan.noise_counts.has_value() || !plan.calibration.noise.empty();
  return plan;
}

OpenedSensor play_sensor(std::unique_ptr<FrameStream> stream, const std::string& name,
                         const LiveOptions& options) {
  const SolverPlan plan = live_plan(*stream, options);
  Processor processor(open_device(options.producer.device), plan,
                      {.memory = options.producer.memory,
                       .frames_in_flight = kFramesInFlight,
                       .on_compiling = options.producer.on_compiling});
  auto curves = std::make_shared<Curves>(plan.skin.element_pitch_mm(), kMostLivePoints);
  return {std::make_unique<LivePlayer>(std::move(stream), name, plan, std::move(processor), curves,
                                       options.producer.plan.read.threshold_counts.has_value()),
          curves};
}

OpenedSensor open_sensor(const std::string& source, const LiveOptions& options) {
  LiveSourceOptions live;
  live.stop = options.stop;
  live.say = options.say;
  live.size = stated_size(options.producer.plan);
  live.read = options.producer.plan.read;
  if (source.starts_with("shm:")) {
    if (auto results = open_result_stream(source, options.stop)) {
      return open_results(std::move(results), source, options);
    }
  }
  std::unique_ptr<FrameStream> stream = open_live_source(source, live);
  return stream == nullptr ? OpenedSensor{} : play_sensor(std::move(stream), source, options);
}

}  // namespace pillarfield::viewer
