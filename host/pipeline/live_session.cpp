#include "pillarfield/live_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <future>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "pillarfield/error.h"
#include "pillarfield/live_tare.h"
#include "pillarfield/reading_check.h"
#include "pillarfield/sensel_watch.h"
#include "pillarfield/solve_range.h"

namespace pillarfield {
namespace {

/// Counts latencies in 100 bins per decade, from 1 microsecond to 100 s; quantiles are exact to
/// 2.4 %.
class LatencyHistogram {
 public:
  void add(std::chrono::nanoseconds latency);
  void clear() { *this = {}; }

  /// The latency in ms that at least `fraction` (0..1) of the frames did not exceed, among them
  /// `lost` ones that are later than all others; unset without frames, and for a lost one.
  [[nodiscard]] std::optional<double> quantile_ms(double fraction, std::uint64_t lost = 0) const;
  [[nodiscard]] double worst_ms() const { return worst_ms_; }

 private:
  static constexpr std::size_t kBinsPerDecade = 100;
  static constexpr std::size_t kDecades = 8;

  std::array<std::uint64_t, kBinsPerDecade * kDecades> bins_{};
  std::uint64_t frames_ = 0;
  double worst_ms_ = 0;
};

void LatencyHistogram::add(std::chrono::nanoseconds latency) {
  const double ms = 1e-6 * static_cast<double>(latency.count());
  const double bin = std::ceil(kBinsPerDecade * std::log10(std::max(1e3 * ms, 1.0)));
  ++bins_.at(std::min(static_cast<std::size_t>(bin), bins_.size() - 1));
  ++frames_;
  worst_ms_ = std::max(worst_ms_, ms);
}

std::optional<double> LatencyHistogram::quantile_ms(double fraction, std::uint64_t lost) const {
  const double wanted = std::max(1.0, std::ceil(fraction * static_cast<double>(frames_ + lost)));
  std::uint64_t count = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    count += bins_.at(bin);
    if (static_cast<double>(count) < wanted) continue;
    const double upper = 1e-3 * std::pow(10, static_cast<double>(bin) / kBinsPerDecade);
    return std::min(upper, worst_ms_);
  }
  return std::nullopt;
}

using SessionClock = std::chrono::steady_clock;

double session_seconds(SessionClock::duration time) {
  return std::chrono::duration<double>(time).count();
}

bool has_tare(const Calibration& calibration) {
  return std::ranges::any_of(calibration.tare, [](float tare) { return tare != 0; });
}

struct TareRequest {
  std::chrono::nanoseconds duration;
  bool preloaded;
  std::uint64_t tag;
};

/// A recording that is being completed in a thread.
struct Completion {
  std::uint64_t tag;
  std::unique_ptr<LiveSink> sink;
  std::future<void> done = {};
};

}  // namespace

namespace {

void describe_plan(LiveSinkInfo& info, const SolverPlan& plan) {
  if (info.forces.contacts) set_sensor(*info.forces.contacts, plan);
  info.skin = plan.skin;
  info.sensel_type = plan.sensel_type;
  info.calibration = plan.calibration;
}

}  // namespace

LiveSinkInfo live_sink_info(const SolverPlan& plan, const std::string& device,
                            const std::string& source,
                            const std::optional<ContactOptions>& contacts) {
  LiveSinkInfo info;
  info.forces = file_info(plan, device, source);
  info.forces.contacts = contacts;
  describe_plan(info, plan);
  return info;
}

/// The source and the sink that the pipeline sees.
struct LiveSession::State final : FrameStream, ForceSink {
  State(FrameStream& from, const SolverPlan& plan, Processor& solver, LiveSinkInfo described,
        bool keeps_threshold)
      : source(from),
        processor(solver),
        live_tare(plan, keeps_threshold),
        watch(plan),
        info(std::move(described)) {
    set_plan(plan);
  }

  [[nodiscard]] const Skin& skin() const override { return source.skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return source.sensel_type(); }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) override;
  void append(const SolvedFrame& frame) override;
  void take_tare(const StreamedFrame& frame);
  void set_plan(const SolverPlan& plan);
  [[nodiscard]] LiveEvent pass_tare_on(const SolverPlan& plan);
  void complete(Completion& completion);
  void look_at_contact(std::span<const std::uint8_t> status, SessionClock::time_point now);
  [[nodiscard]] HealthReport health_now() const;

  FrameStream& source;
  Processor& processor;
  // Members of the thread of run().
  std::optional<std::uint64_t> most_frames;
  ContactTracker* contacts = nullptr;  ///< of the run
  std::uint64_t taken = 0;             ///< frames that the pipeline got
  LiveTare live_tare;
  std::uint64_t tare_tag = 0;
  bool started = false;

  SenselWatch watch;
  std::atomic<bool> paused = false;
  std::atomic<bool> holds = false;  ///< frames, until there is a tare
  std::uint64_t held = 0;

  std::mutex record_mutex;
  mutable std::mutex mutex;  ///< guards all that follows
  LiveSinkInfo info;
  std::optional<TareRequest> tare_request;
  bool taring = false;
  std::vector<std::unique_ptr<LiveSink>> sinks;
  LiveSink* recording = nullptr;  ///< one of the sinks
  bool recording_awaits_tare = false;
  std::vector<Completion> completions;
  std::vector<LiveEvent> events;
  StreamHealth stream;
  std::uint64_t received = 0;
  std::uint64_t solved = 0;
  LatencyHistogram all_latencies;
  LatencyHistogram recent_latencies;
  SessionClock::time_point last_arrival = SessionClock::now();
  SessionClock::time_point last_report = last_arrival;
  std::uint64_t received_at_report = 0;
  double replay_hz = 0;         ///< over the last report
  std::size_t existing = 0;     ///< elements that are not absent
  double share_in_contact = 0;  ///< of those
  double covered = 0;           ///< part of about the last second in which contact covers the array
  SessionClock::time_point next_look = last_arrival;
};

Arrival LiveSession::State::next(StreamedFrame& frame, std::chrono::nanoseconds timeout) {
  if (most_frames && taken >= *most_frames) return Arrival::ended;
  const Arrival arrival = source.next(frame, timeout);
  {
    const std::scoped_lock lock(mutex);
    stream = source.health();
    if (arrival != Arrival::arrived) return arrival;
    last_arrival = SessionClock::now();
    ++received;
  }
  if (frame.missing.empty()) {
    watch.offer(frame.readings);
    take_tare(frame);
  }
  if (holds) ++held;
  if (paused || holds) return Arrival::timed_out;
  ++taken;
  return arrival;
}

void LiveSession::State::take_tare(const StreamedFrame& frame) {
  {
    const std::scoped_lock lock(mutex);
    if (const auto request = std::exchange(tare_request, {})) {
      live_tare.start(request->duration, request->preloaded, processor.tare());
      tare_tag = request->tag;
    }
  }
  if (!live_tare.is_running()) return;
  LiveEvent event;
  try {
    const SolverPlan* const plan = live_tare.add(frame.readings, frame.arrived);
    if (plan == nullptr) return;
    processor.set_plan(*plan);
    watch.set_plan(*plan);
    if (contacts != nullptr) contacts->set_sensor(*plan);
    event = pass_tare_on(*plan);
    if (holds.exchange(false)) {
      event.note += fmt::format("; {} before it went nowhere", counted(held, "frame"));
    }
  } catch (const Error& error) {
    event.error = error.what();
  }
  event.tag = tare_tag;
  const std::scoped_lock lock(mutex);
  taring = false;
  events.push_back(std::move(event));
}

void LiveSession::State::set_plan(const SolverPlan& plan) {
  describe_plan(info, plan);
  existing = plan.skin.elements() - count_absent_elements(plan.calibration, plan.skin);
}

LiveEvent LiveSession::State::pass_tare_on(const SolverPlan& plan) {
  LiveEvent event = {.note = live_tare.note()};
  const std::scoped_lock lock(mutex);
  set_plan(plan);
  covered = 0;
  if (recording == nullptr) return event;
  if (std::exchange(recording_awaits_tare, false)) {
    recording->set_tare(info);
  } else {
    event.recording = recording->name();
  }
  return event;
}

void LiveSession::State::append(const SolvedFrame& frame) {
  const std::scoped_lock lock(mutex);
  for (const auto& sink : sinks) sink->append(frame);
  const auto now = SessionClock::now();
  look_at_contact(frame.forces.status, now);
  const auto latency = now.time_since_epoch() - frame.arrived;
  all_latencies.add(latency);
  recent_latencies.add(latency);
  ++solved;
}

void LiveSession::State::look_at_contact(std::span<const std::uint8_t> status,
                                         SessionClock::time_point now) {
  if (now < next_look) return;
  next_look = now + std::chrono::milliseconds(50);
  share_in_contact = static_cast<double>(count_in_contact(status)) /
                     static_cast<double>(std::max<std::size_t>(existing, 1));
  covered += ((share_in_contact >= kCovered ? 1 : 0) - covered) / 10;
}

void LiveSession::State::complete(Completion& completion) {
  completion.done.get();
  LiveEvent event = {.kind = LiveEvent::Kind::recording,
                     .tag = completion.tag,
                     .recording = completion.sink->name(),
                     .recorded = completion.sink->statistics()};
  event.error = event.recorded.failure;
  events.push_back(std::move(event));
}

HealthReport LiveSession::State::health_now() const {
  HealthReport health;
  health.stream = stream;
  if (stream.frames == 0) {  // A replayed file keeps no count.
    health.stream.frames = received;
    health.stream.rate_hz = replay_hz;
  }
  health.solved = solved;
  health.latency_ms_median = recent_latencies.quantile_ms(0.5).value_or(0);
  health.latency_ms_worst = recent_latencies.worst_ms();
  health.since_frame_s = session_seconds(SessionClock::now() - last_arrival);
  const SenselHealth sensels = watch.health();
  health.dead = sensels.dead;
  health.stuck = sensels.stuck;
  health.drifting = sensels.drifting;
  if (covered > 0.8 && share_in_contact >= kCovered) {
    health.coverage =
        coverage_words(share_in_contact, has_tare(info.calibration), info.skin.layout);
  }
  return health;
}

LiveSession::LiveSession(FrameStream& source, const SolverPlan& plan, Processor& processor,
                         LiveSinkInfo info, bool keeps_threshold)
    : state_(std::make_unique<State>(source, plan, processor, std::move(info), keeps_threshold)) {}

LiveSession::~LiveSession() = default;

void LiveSession::add(std::unique_ptr<LiveSink> sink) {
  const std::scoped_lock lock(state_->mutex);
  state_->sinks.push_back(std::move(sink));
}

PipelineStatistics LiveSession::run(const Run& options) {
  if (!std::exchange(state_->started, true)) {
    const std::scoped_lock lock(state_->mutex);
    state_->last_arrival = state_->last_report = SessionClock::now();
  }
  state_->most_frames = options.frames;
  state_->contacts = options.contacts;
  std::vector<ForceSink*> sinks = {state_.get()};
  if (options.sink != nullptr) sinks.push_back(options.sink);
  Pipeline pipeline(*state_, state_->processor, std::move(sinks),
                    {.frames_in_flight = options.frames_in_flight,
                     .contacts = options.contacts,
                     .stop = options.stop});
  return pipeline.run();
}

void LiveSession::finish() {
  const std::scoped_lock lock(state_->mutex);
  for (const auto& sink : state_->sinks) sink->finish();
  for (Completion& each : state_->completions) state_->complete(each);
  state_->completions.clear();
}

bool LiveSession::start_tare(std::chrono::nanoseconds duration, bool preloaded, std::uint64_t tag,
                             bool holds) {
  const std::scoped_lock lock(state_->mutex);
  if (std::exchange(state_->taring, true)) return false;
  if (holds) state_->holds = true;
  state_->tare_request = TareRequest{duration, preloaded, tag};
  return true;
}

bool LiveSession::is_taring() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->taring;
}

void LiveSession::set_paused(bool paused) { state_->paused = paused; }
bool LiveSession::is_paused() const { return state_->paused; }

void LiveSession::record(const std::filesystem::path& path) {
  // One at a time; the file is created without the lock that frames need.
  const std::scoped_lock alone(state_->record_mutex);
  LiveSinkInfo info;
  {
    const std::scoped_lock lock(state_->mutex);
    if (state_->recording != nullptr) {
      throw Error("record", state_->recording->name() + " is being recorded", "stop that first");
    }
    info = state_->info;
  }
  std::unique_ptr<LiveSink> sink = create_live_recording(path.string(), info);
  const std::scoped_lock lock(state_->mutex);
  state_->recording = sink.get();
  state_->recording_awaits_tare = state_->taring || !has_tare(state_->info.calibration);
  state_->sinks.push_back(std::move(sink));
}

std::string LiveSession::recording() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->recording == nullptr ? "" : state_->recording->name();
}

bool LiveSession::stop_recording(std::uint64_t tag) {
  const std::scoped_lock lock(state_->mutex);
  const auto sink = std::ranges::find(state_->sinks, std::exchange(state_->recording, nullptr),
                                      &std::unique_ptr<LiveSink>::get);
  if (sink == state_->sinks.end()) return false;
  state_->completions.push_back({.tag = tag, .sink = std::move(*sink)});
  state_->sinks.erase(sink);
  Completion& last = state_->completions.back();
  last.done = std::async(std::launch::async, [to = last.sink.get()] { to->finish(); });
  return true;
}

LiveSinkInfo LiveSession::info() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->info;
}

std::vector<LiveEvent> LiveSession::take_events() {
  const std::scoped_lock lock(state_->mutex);
  std::erase_if(state_->completions, [&](Completion& each) {
    if (each.done.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
    state_->complete(each);
    return true;
  });
  return std::exchange(state_->events, {});
}

std::vector<LiveSession::Sink> LiveSession::sinks() const {
  const std::scoped_lock lock(state_->mutex);
  std::vector<Sink> sinks;
  for (const auto& sink : state_->sinks) sinks.push_back({sink->name(), sink->statistics()});
  return sinks;
}

HealthReport LiveSession::health() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->health_now();
}

HealthReport LiveSession::report() {
  const std::scoped_lock lock(state_->mutex);
  const auto now = SessionClock::now();
  state_->replay_hz = static_cast<double>(state_->received - state_->received_at_report) /
                      std::max(1e-9, session_seconds(now - state_->last_report));
  state_->received_at_report = state_->received;
  state_->last_report = now;
  HealthReport health = state_->health_now();
  state_->recent_latencies.clear();
  for (const auto& sink : state_->sinks) sink->report(health);
  return health;
}

std::optional<double> LiveSession::latency_ms(double fraction, std::uint64_t lost) const {
  const std::scoped_lock lock(state_->mutex);
  return state_->all_latencies.quantile_ms(fraction, lost);
}

double LiveSession::worst_latency_ms() const {
  const std::scoped_lock lock(state_->mutex);
  return state_->all_latencies.worst_ms();
}

}  // namespace pillarfield
