#include "viewer/source/live_player.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "pillarfield/calibration_file.h"
#include "pillarfield/error.h"
#include "pillarfield/live_tare.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/plan_builder.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/peak_hold.h"
#include "viewer/source/plane_block.h"
#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {
namespace {

using LiveTime = std::chrono::nanoseconds;

constexpr auto kTareTime = std::chrono::milliseconds(500);
/// Points of the curves of a sensor: two minutes at 1 kHz.
constexpr std::size_t kMostLivePoints = 120'000;

LiveTime live_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

double live_seconds(LiveTime time) { return std::chrono::duration<double>(time).count(); }

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
  info.solver = fmt::format("{} on {}", name_of(plan.estimator), processor.device().info().name);
  return info;
}

/// The readings of a field on display, and its forces where pillars without readings were taken
/// out.
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

void copy_readings(const FrameView& from, FrameBuffer& to) {
  const std::size_t row_bytes = from.cols * size_of(from.type);
  const auto* source = static_cast<const std::byte*>(from.data);
  std::byte* const target = to.bytes().data();
  for (std::uint32_t row = 0; row < from.rows; ++row) {
    std::copy_n(source + row * from.row_stride * size_of(from.type), row_bytes,
                target + row * row_bytes);
  }
}

}  // namespace

struct LivePlayer::State final : FrameStream, ForceSink {
  State(std::unique_ptr<FrameStream> from, const std::string& name, SolverPlan with,
        Processor solver, std::shared_ptr<Curves> measured);
  ~State() override;

  // The stream as the pipeline sees it.
  [[nodiscard]] const Skin& skin() const override { return stream->skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return stream->sensel_type(); }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) override;

  void append(const SolvedFrame& frame) override;

  // Run in the thread.
  void run();
  void run_pipeline();
  void take_tare(const StreamedFrame& frame);
  [[nodiscard]] std::string pass_tare_on(const std::vector<float>& measured);
  void follow_clock(const SolvedFrame& frame);
  [[nodiscard]] ShownField field_of(const SolvedFrame& frame, std::uint64_t index) const;
  void publish(const SolvedFrame& frame);
  void wake_display();

  void tell(std::string words);

  const std::unique_ptr<FrameStream> stream;
  const SolverPlan plan;
  Processor processor;
  const SourceInfo info;
  const std::shared_ptr<Curves> curves;
  const LiveTime start = live_now();
  // Of the thread.
  ContactTracker tracker;
  LiveTare live_tare;
  PeakHold peak;
  ObjectPool<LiveField> fields;
  bool tracks = false;
  double last_time_s = -1;               ///< of the frame solved last, since `start`
  std::optional<double> clock_offset_s;  ///< that time less the sensor's
  SenselWatch watch;

  std::atomic<bool> stopping = false;
  std::atomic<bool> paused = false;
  std::atomic<bool> wants_contacts = false;
  std::atomic<bool> wants_peak = false;
  std::atomic<bool> peak_begins = false;
  std::atomic<bool> wants_tare = false;
  std::atomic<bool> taring = false;
  std::atomic<bool> ended = false;
  std::atomic<std::uint64_t> solved = 0;
  std::atomic<LiveTime> last_arrival{start};

  mutable std::mutex mutex;  ///< guards the members up to `failed`
  StreamHealth health;
  std::vector<float> tare;
  std::unique_ptr<ShownField> waiting;
  std::uint64_t taken = 0;
  RecentTimes times;
  std::string message;
  std::uint64_t messages = 0;
  std::exception_ptr failed;

  mutable std::mutex recording_mutex;  ///< guards the next three members
  std::unique_ptr<LiveSink> recording;
  bool recording_awaits_tare = false;  ///< the next tare is that of its frames
  std::future<void> finishing;

  std::mutex waking;  ///< guards `wake`, also while it runs
  std::function<void()> wake;
  std::thread thread;  ///< last: uses the other members
};

LivePlayer::State::State(std::unique_ptr<FrameStream> from, const std::string& name,
                         SolverPlan with, Processor solver, std::shared_ptr<Curves> measured)
    : stream(std::move(from)),
      plan(std::move(with)),
      processor(std::move(solver)),
      info(live_info(name, plan, processor)),
      curves(std::move(measured)),
      tracker(plan.skin.pillar_pitch_mm(), info.contacts),
      live_tare(plan.skin, plan.sensel_type),
      fields(FieldProducer::kMostShown, [this] { return std::make_unique<LiveField>(plan); }),
      watch(plan),
      tare(plan.calibration.tare),
      thread([this] { run(); }) {}

LivePlayer::State::~State() {
  stopping = true;
  thread.join();
  if (finishing.valid()) finishing.wait();
  if (recording == nullptr) return;
  recording->finish();
  const std::string failure = recording->statistics().failure;
  if (!failure.empty()) fmt::print(stderr, "pillarfield-viewer: {}\n", failure);
}

void LivePlayer::State::run() {
  try {
    stream->discard_waiting();
    while (!stopping && !ended) run_pipeline();
  } catch (...) {
    const std::scoped_lock lock(mutex);
    failed = std::current_exception();
  }
  ended = true;
  wake_display();
}

/// Runs until the player ends, or contacts are switched.
void LivePlayer::State::run_pipeline() {
  tracks = wants_contacts;
  if (tracks) tracker = ContactTracker(plan.skin.pillar_pitch_mm(), info.contacts);
  Pipeline pipeline(*this, processor, {this},
                    {.contacts = tracks ? &tracker : nullptr,
                     .stop = [this] { return stopping || tracks != wants_contacts; }});
  ended = !pipeline.run().stopped;
}

Arrival LivePlayer::State::next(StreamedFrame& frame, std::chrono::nanoseconds timeout) {
  const Arrival arrival = stream->next(frame, timeout);
  {
    const std::scoped_lock lock(mutex);
    health = stream->health();
  }
  if (arrival != Arrival::arrived) return arrival;
  last_arrival = frame.arrived;
  if (!frame.missing.empty()) return arrival;
  watch.offer(frame.readings);
  take_tare(frame);
  return arrival;
}

void LivePlayer::State::take_tare(const StreamedFrame& frame) {
  if (wants_tare.exchange(false)) live_tare.start(kTareTime);
  if (!live_tare.is_running()) return;
  std::string said;
  try {
    const std::vector<float>* const measured = live_tare.add(frame.readings, frame.arrived);
    if (measured == nullptr) return;
    processor.set_tare(*measured);
    watch.set_tare(*measured);
    {
      const std::scoped_lock lock(mutex);
      tare = *measured;
    }
    said = pass_tare_on(*measured);
  } catch (const Error& error) {
    taring = false;
    tell(error.what());
    return;
  }
  taring = false;
  tell(said);
}

/// A recording states one tare for all of its frames: the first one. Returns what to tell.
std::string LivePlayer::State::pass_tare_on(const std::vector<float>& measured) {
  const std::scoped_lock lock(recording_mutex);
  if (recording == nullptr) return "tare taken";
  if (!std::exchange(recording_awaits_tare, false)) {
    return "tare taken; the recording keeps that of its start";
  }
  recording->set_tare(measured);
  return "tare taken";
}

void LivePlayer::State::tell(std::string words) {
  const std::scoped_lock lock(mutex);
  message = std::move(words);
  ++messages;
}

ShownField LivePlayer::State::field_of(const SolvedFrame& frame, std::uint64_t index) const {
  ShownField field;
  field.forces = frame.forces;
  field.raw = frame.readings;
  field.time_s = last_time_s;
  field.index = index;
  field.arrived = frame.arrived;
  if (plan.estimator == Estimator::direct) field.direct_point = plan.segment_point;
  field.shear_coefficient = plan.calibration.effects.shear_coefficient.value_or(ShearCoefficient{});
  return field;
}

/// Follows the sensor's clock from the first frame on, which evens out delays on the way; where it
/// stands still, jumps, or leaves the time of arrival, takes that.
void LivePlayer::State::follow_clock(const SolvedFrame& frame) {
  constexpr double kMostApartS = 5;
  constexpr double kLeastStepS = 1e-6;
  const double arrived_s = live_seconds(frame.arrived - start);
  const double by_sensor_s = frame.time_s + clock_offset_s.value_or(arrived_s - frame.time_s);
  const bool follows = clock_offset_s && by_sensor_s > last_time_s &&
                       std::abs(by_sensor_s - arrived_s) < kMostApartS;
  last_time_s = follows ? by_sensor_s : std::max(arrived_s, last_time_s + kLeastStepS);
  clock_offset_s = last_time_s - frame.time_s;
}

void LivePlayer::State::append(const SolvedFrame& frame) {
  follow_clock(frame);
  {
    const std::scoped_lock lock(recording_mutex);
    if (recording != nullptr) recording->append(frame);
  }
  curves->add(field_of(frame, solved));
  if (wants_peak) {
    if (peak_begins.exchange(false)) peak.reset();
    peak.add(frame.forces);
  }
  ++solved;
  if (!paused) publish(frame);
  const std::scoped_lock lock(mutex);
  times.add(frame.arrived, live_now());
}

/// Hands the frame solved last to the display: its forces in place, its readings copied.
void LivePlayer::State::publish(const SolvedFrame& frame) {
  const auto owner = std::make_shared<LiveFieldOwner>(fields.acquire());
  if (owner->field == nullptr) return;
  copy_readings(frame.readings, owner->field->readings);
  auto field = std::make_unique<ShownField>(field_of(frame, solved - 1));
  field->raw = owner->field->readings.view();
  if (frame.missing.empty()) {
    owner->result = processor.pin();
    field->pages = owner->result->pages();
  } else {
    std::optional<PlaneBlock>& planes = owner->field->planes;
    if (!planes) planes.emplace(frame.forces.rows, frame.forces.cols, plan.uncertainty);
    planes->copy(frame.forces);
    field->forces = planes->view();
    field->pages = planes->pages();
  }
  field->keep_alive = owner;
  if (tracks) {
    field->contacts = std::make_shared<const ShownContacts>(
        with_extents(*frame.contacts, tracker.labels(), info.contacts.noise_n));
  }
  if (wants_peak) field->peak = peak.field(*field);
  {
    const std::scoped_lock lock(mutex);
    std::swap(waiting, field);
  }
  field.reset();
  wake_display();
}

void LivePlayer::State::wake_display() {
  const std::scoped_lock lock(waking);
  if (wake) wake();
}

LivePlayer::LivePlayer(std::unique_ptr<FrameStream> stream, const std::string& name,
                       const SolverPlan& plan, Processor processor, std::shared_ptr<Curves> curves)
    : state_(std::make_unique<State>(std::move(stream), name, plan, std::move(processor),
                                     std::move(curves))) {}

LivePlayer::~LivePlayer() = default;

const SourceInfo& LivePlayer::info() const { return state_->info; }
void LivePlayer::play() { state_->paused = false; }
void LivePlayer::pause() { state_->paused = true; }
void LivePlayer::set_contacts(bool wanted) { state_->wants_contacts = wanted; }

void LivePlayer::set_peak(bool wanted) {
  state_->peak_begins = wanted;
  state_->wants_peak = wanted;
}

PlayerState LivePlayer::state() const {
  const std::scoped_lock lock(state_->mutex);
  return {.frame = state_->solved,
          .frames = 0,
          .playing = !state_->paused,
          .loops = false,
          .follows = true,
          .speed = 1,
          .rate_hz = state_->health.rate_hz};
}

PlayerStatistics LivePlayer::statistics() const {
  const std::scoped_lock lock(state_->mutex);
  state_->times.forget_before(live_now());
  PlayerStatistics statistics;
  statistics.produced = state_->solved;
  statistics.taken = state_->taken;
  statistics.waiting = state_->waiting != nullptr ? 1 : 0;
  statistics.not_shown = statistics.produced - statistics.taken - statistics.waiting;
  statistics.produced_hz = state_->times.rate_hz();
  statistics.produce_ms_median = state_->times.median_ms();
  statistics.produce_ms_worst = state_->times.worst_ms();
  return statistics;
}

std::optional<ShownField> LivePlayer::take() {
  const std::scoped_lock lock(state_->mutex);
  if (state_->waiting != nullptr) {
    ++state_->taken;
    return std::move(*std::exchange(state_->waiting, nullptr));
  }
  if (state_->failed) std::rethrow_exception(std::exchange(state_->failed, nullptr));
  return std::nullopt;
}

void LivePlayer::on_new_field(std::function<void()> wake) {
  const std::scoped_lock lock(state_->waking);
  state_->wake = std::move(wake);
}

void LivePlayer::tare() {
  state_->taring = true;
  state_->wants_tare = true;
}

void LivePlayer::record(const std::filesystem::path& path) {
  stop_recording();
  LiveSinkInfo info;
  {
    const std::scoped_lock lock(state_->mutex);
    info = sink_info(state_->plan, "", state_->info.name);
    info.calibration.tare = state_->tare;
    info.replace = Replace::nothing;
  }
  auto sink = create_live_recording(path.string(), info);
  const std::scoped_lock lock(state_->recording_mutex);
  state_->recording = std::move(sink);
  state_->recording_awaits_tare =
      state_->taring ||
      std::ranges::none_of(info.calibration.tare, [](float tare) { return tare != 0; });
}

void LivePlayer::stop_recording() {
  std::unique_ptr<LiveSink> sink;
  {
    const std::scoped_lock lock(state_->recording_mutex);
    sink = std::move(state_->recording);
  }
  if (sink == nullptr) return;
  if (state_->finishing.valid()) state_->finishing.wait();
  state_->finishing =
      std::async(std::launch::async, [this, finished = std::shared_ptr(std::move(sink))] {
        finished->finish();
        const LiveSinkStatistics statistics = finished->statistics();
        state_->tell(fmt::format("recorded {}: {}", recorded_words(statistics), finished->name()));
      });
}

std::string recorded_words(const LiveSinkStatistics& recorded) {
  std::string words = fmt::format("{} frames", recorded.frames);
  if (recorded.dropped > 0) words += fmt::format(", {} dropped", recorded.dropped);
  if (!recorded.failure.empty()) words += ", failed: " + recorded.failure;
  return words;
}

LiveStatus LivePlayer::status() const {
  LiveStatus status;
  {
    const std::scoped_lock lock(state_->mutex);
    status.stream = state_->health;
    status.message = state_->message;
    status.messages = state_->messages;
  }
  status.sensels = state_->watch.health();
  status.solved = state_->solved;
  status.silent_s = live_seconds(live_now() - state_->last_arrival.load());
  status.ended = state_->ended;
  status.taring = state_->taring;
  const std::scoped_lock lock(state_->recording_mutex);
  if (state_->recording == nullptr) return status;
  status.recording = state_->recording->name();
  status.recorded = state_->recording->statistics();
  return status;
}

SolverPlan live_plan(const FrameStream& stream, const LiveOptions& options) {
  PlanSources from;
  std::optional<SkinCalibration> calibration;
  if (!options.calibration.empty()) {
    calibration = read_calibration_file(options.calibration, options.producer.read);
    from.calibration = &*calibration;
  }
  from.settings.counts_per_newton = options.counts_per_newton;
  SolverPlan plan = build_plan(plan_of_frames(stream), from, options.calibration.string(),
                               [&] { return SolverPlan{}.frame_interval_s; });
  if (plan.calibration.tare.empty()) plan.calibration.tare.assign(plan.skin.sensels(), 0);
  plan.angles = true;
  plan.uncertainty = plan.noise_counts.has_value() || !plan.calibration.noise.empty();
  return plan;
}

OpenedSensor open_sensor(const std::string& source, const LiveOptions& options) {
  LiveSourceOptions live;
  live.stop = options.stop;
  live.say = options.say;
  if (!options.calibration.empty()) {
    const auto stated = read_calibration_file(options.calibration, options.producer.read);
    live.size = {stated.rows, stated.cols};
  }
  std::unique_ptr<FrameStream> stream = open_live_source(source, live);
  if (stream == nullptr) return {};
  const SolverPlan plan = live_plan(*stream, options);
  Processor processor(open_device(options.producer.device), plan,
                      {.memory = options.producer.memory,
                       .frames_in_flight = LivePlayer::kFramesInFlight,
                       .on_compiling = options.producer.on_compiling});
  OpenedSensor opened;
  opened.curves = std::make_shared<Curves>(plan.skin.pillar_pitch_mm(), kMostLivePoints);
  opened.player = std::make_unique<LivePlayer>(std::move(stream), source, plan,
                                               std::move(processor), opened.curves);
  return opened;
}

}  // namespace pillarfield::viewer
