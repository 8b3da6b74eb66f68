#include "cli/stream/session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <future>
#include <sstream>
#include <utility>

#include "cli/json_text.h"
#include "base/number_text.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

constexpr double kTareSeconds = 0.5;
constexpr double kMostTareSeconds = 60;

std::chrono::nanoseconds nanoseconds_of(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
}

double seconds_of(std::chrono::nanoseconds time) {
  return 1e-9 * static_cast<double>(time.count());
}

std::vector<std::string> words_of(std::string_view line) {
  std::istringstream text{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

/// What follows a word of a line, without blanks around it.
std::string rest_of(std::string_view line, const std::string& word) {
  line.remove_prefix(line.find(word) + word.size());
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return std::string(line.substr(0, line.find_last_not_of(" \t") + 1));
}

std::string done_line(const std::string& what) { return json_text({{"ok", true}, {"done", what}}); }

std::string failed_line(const std::string& why) {
  return json_text({{"ok", false}, {"error", why}});
}

bool has_tare(const LiveSinkInfo& info) {
  return std::ranges::any_of(info.calibration.tare, [](float tare) { return tare != 0; });
}

nlohmann::ordered_json sink_json(const LiveSink& sink) {
  const LiveSinkStatistics statistics = sink.statistics();
  nlohmann::ordered_json json = {{"name", sink.name()},
                                 {"frames", statistics.frames},
                                 {"dropped", statistics.dropped},
                                 {"clients", statistics.clients},
                                 {"refused", statistics.refused}};
  if (!statistics.failure.empty()) json["failure"] = statistics.failure;
  if (!statistics.notice.empty()) json["notice"] = statistics.notice;
  return json;
}

}  // namespace

/// The source, paused and observed.
class StreamSession::Source final : public FrameStream {
 public:
  Source(StreamSession& session, FrameStream& stream) : session_(session), stream_(stream) {}

  [[nodiscard]] const Skin& skin() const override { return stream_.skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return stream_.sensel_type(); }
  [[nodiscard]] StreamHealth health() const override { return stream_.health(); }
  void discard_waiting() override { stream_.discard_waiting(); }

  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds timeout) override {
    const std::optional<std::uint64_t>& most = session_.options_.frames;
    if (most && taken_ >= *most) return Arrival::ended;
    const Arrival arrival = stream_.next(frame, timeout);
    if (arrival != Arrival::arrived) return arrival;
    session_.last_arrival_ = Clock::now();
    ++session_.received_;
    if (frame.missing.empty()) {
      session_.watch_.offer(frame.readings);
      session_.take_tare(frame.readings, frame.arrived);
    }
    if (session_.paused_) return Arrival::timed_out;
    ++taken_;
    return arrival;
  }

 private:
  StreamSession& session_;
  FrameStream& stream_;
  std::uint64_t taken_ = 0;  ///< frames that the pipeline got
};

/// All live sinks; sinks may come and go between frames.
class StreamSession::Sinks final : public ForceSink {
 public:
  explicit Sinks(StreamSession& session) : session_(session) {}

  void add(std::unique_ptr<LiveSink> sink) { sinks_.push_back(std::move(sink)); }

  void append(const SolvedFrame& frame) override {
    for (const auto& sink : sinks_) sink->append(frame);
    const auto latency = Clock::now().time_since_epoch() - frame.arrived;
    session_.all_latencies_.add(latency);
    session_.recent_latencies_.add(latency);
    const std::optional<double>& rate_hz = session_.options_.rate_hz;
    if (rate_hz && latency > nanoseconds_of(1 / *rate_hz)) ++session_.missed_;
    session_.contacts_ = frame.contacts->contacts.size();
    ++session_.solved_;
  }

  void finish() override {
    for (const auto& sink : sinks_) sink->finish();
    for (const Finishing& finishing : finishing_) finishing.done.wait();
  }

  /// Removes the sink `name` and completes it in a thread, which waits for the disk; then
  /// take_finished() reports it to `client`.
  void finish_later(const std::string& name, std::uint64_t client) {
    const auto sink = std::ranges::find(sinks_, name, &LiveSink::name);
    if (sink == sinks_.end()) return;
    finishing_.push_back({.client = client, .sink = std::move(*sink)});
    Finishing& last = finishing_.back();
    sinks_.erase(sink);
    last.done = std::async(std::launch::async, [to = last.sink.get()] { to->finish(); });
  }

  /// Calls `done` with client and sink for each sink that is complete since the last call.
  template <class Done>
  void take_finished(Done done) {
    std::erase_if(finishing_, [&](Finishing& finishing) {
      if (finishing.done.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
      finishing.done.get();
      note_failure(*finishing.sink);
      done(finishing.client, *finishing.sink);
      return true;
    });
  }

  void set_tare(const std::vector<float>& tare) {
    for (const auto& sink : sinks_) sink->set_tare(tare);
  }

  void report(const HealthReport& health) {
    for (const auto& sink : sinks_) {
      sink->report(health);
      note_failure(*sink);
      tell_notice(*sink);
    }
  }

  [[nodiscard]] bool has_failed() const { return !failed_.empty(); }
  [[nodiscard]] const std::vector<std::unique_ptr<LiveSink>>& all() const { return sinks_; }

 private:
  struct Finishing {
    std::uint64_t client;
    std::unique_ptr<LiveSink> sink;
    std::future<void> done = {};
  };

  void tell_notice(const LiveSink& sink) {
    const std::string notice = sink.statistics().notice;
    if (notice.empty() || std::ranges::count(noticed_, sink.name()) > 0) return;
    noticed_.push_back(sink.name());
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(sink.name()), printable(notice));
  }

  void note_failure(const LiveSink& sink) {
    const std::string failure = sink.statistics().failure;
    if (failure.empty() || std::ranges::count(failed_, sink.name()) > 0) return;
    failed_.push_back(sink.name());
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(sink.name()), printable(failure));
  }

  StreamSession& session_;
  std::vector<std::unique_ptr<LiveSink>> sinks_;
  std::vector<Finishing> finishing_;
  std::vector<std::string> failed_;
  std::vector<std::string> noticed_;  ///< sinks whose notice was told
};

StreamSession::StreamSession(const StreamOptions& options, FrameStream& source,
                             const SolverPlan& plan, Processor& processor, LiveSinkInfo info)
    : options_(options),
      plan_(plan),
      processor_(processor),
      info_(std::move(info)),
      tracker_(plan.skin.pillar_pitch_mm(), *info_.forces.contacts),
      tare_(plan.skin, plan.sensel_type),
      watch_(plan),
      source_(std::make_unique<Source>(*this, source)),
      sinks_(std::make_unique<Sinks>(*this)),
      control_(options.control) {
  for (const std::string& target : options.sinks) sinks_->add(create_live_sink(target, info_));
  if (!options.record.empty()) {
    sinks_->add(create_live_recording(options.record, info_));
    recording_ = options.record;
    recording_awaits_tare_ = options.tare_s > 0 || !has_tare(info_);
  }
  if (options.tare_s > 0) tare_.start(nanoseconds_of(options.tare_s));
}

StreamSession::~StreamSession() = default;

void StreamSession::run() {
  source_->discard_waiting();
  start_ = last_arrival_ = last_report_ = Clock::now();
  next_report_ = start_ + nanoseconds_of(options_.health_interval_s);
  Pipeline pipeline(*source_, processor_, {sinks_.get()},
                    {.frames_in_flight = options_.frames_in_flight,
                     .contacts = &tracker_,
                     .stop = [this] { return should_stop(); }});
  pipeline.run();
  report_health();
  if (line_drawn_) fmt::print(stderr, "\n");
  sinks_->finish();
  answer_finished();
  sinks_->report(last_health_);
  if (sinks_->has_failed()) {
    throw Error(options_.source, "an output failed; see above", "mend it and start again");
  }
}

bool StreamSession::should_stop() {
  control_.poll([this](std::uint64_t client, std::string_view line) { return obey(client, line); });
  answer_finished();
  const auto now = Clock::now();
  if (now >= next_report_) report_health();
  return quit_ || is_interrupted() ||
         (options_.seconds && now - start_ >= nanoseconds_of(*options_.seconds)) ||
         (options_.most_idle_s && now - last_arrival_ >= nanoseconds_of(*options_.most_idle_s));
}

void StreamSession::take_tare(const FrameView& frame, std::chrono::nanoseconds arrived) {
  std::string said;
  try {
    const std::vector<float>* const tare = tare_.add(frame, arrived);
    if (tare == nullptr) return;
    processor_.set_tare(*tare);
    watch_.set_tare(*tare);
    info_.calibration.tare = *tare;
    said = pass_tare_on(*tare);
  } catch (const Error& error) {
    said = failed_line(error.what());
    if (tare_client_ == 0) fmt::print(stderr, "pillarfield: {}\n", printable(error.what()));
  }
  control_.answer(std::exchange(tare_client_, 0), said);
}

/// A recording states one tare for all of its frames: the first one. Returns the answer.
std::string StreamSession::pass_tare_on(const std::vector<float>& tare) {
  if (recording_.empty()) return done_line("tare");
  if (std::exchange(recording_awaits_tare_, false)) {
    sinks_->set_tare(tare);
    return done_line("tare");
  }
  const std::string warning = fmt::format(
      "{} keeps the tare of its start; record another file for the new one", printable(recording_));
  fmt::print(stderr, "pillarfield: {}\n", warning);
  return json_text({{"ok", true}, {"done", "tare"}, {"warning", warning}});
}

/// Answers the clients whose recordings are complete.
void StreamSession::answer_finished() {
  sinks_->take_finished([this](std::uint64_t client, const LiveSink& sink) {
    const std::string failure = sink.statistics().failure;
    control_.answer(client, failure.empty() ? done_line("record stop") : failed_line(failure));
  });
}

HealthReport StreamSession::health() const {
  HealthReport health;
  health.stream = source_->health();
  if (health.stream.frames == 0) {  // A replayed file keeps no count.
    health.stream.frames = received_;
    health.stream.rate_hz = replay_hz_;
  }
  health.solved = solved_;
  health.latency_ms_median = recent_latencies_.quantile_ms(0.5).value_or(0);
  health.latency_ms_worst = recent_latencies_.worst_ms();
  health.since_frame_s = seconds_of(Clock::now() - last_arrival_);
  const SenselHealth sensels = watch_.health();
  health.dead = sensels.dead;
  health.stuck = sensels.stuck;
  health.drifting = sensels.drifting;
  return health;
}

void StreamSession::report_health() {
  const auto now = Clock::now();
  replay_hz_ = static_cast<double>(received_ - received_at_report_) /
               std::max(1e-9, seconds_of(now - last_report_));
  received_at_report_ = received_;
  last_report_ = now;
  last_health_ = health();
  next_report_ = now + nanoseconds_of(options_.health_interval_s);
  sinks_->report(last_health_);
  const std::string& mismatch = last_health_.stream.mismatch;
  if (!mismatch.empty() && !std::exchange(mismatch_told_, true)) {
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(options_.source), mismatch);
  }
  show(last_health_);
  recent_latencies_.clear();
}

nlohmann::ordered_json StreamSession::health_json(const HealthReport& health) const {
  const StreamHealth& stream = health.stream;
  nlohmann::ordered_json json = {
      {"seconds", seconds_of(Clock::now() - start_)},
      {"rate_hz", stream.rate_hz},
      {"frames", stream.frames},
      {"solved", health.solved},
      {"lost", stream.lost},
      {"incomplete", stream.incomplete},
      {"late", stream.late},
      {"duplicates", stream.duplicates},
      {"reordered", stream.reordered},
      {"invalid", stream.invalid},
      {"restarts", stream.restarts},
      {"clock_jumps", stream.clock_jumps},
      {"overrun", stream.overrun},
      {"since_frame_s", health.since_frame_s},
      {"latency_ms", {{"median", health.latency_ms_median}, {"worst", health.latency_ms_worst}}},
      {"sensels", {{"dead", health.dead}, {"stuck", health.stuck}, {"drifting", health.drifting}}},
      {"contacts", contacts_},
      {"paused", paused_}};
  if (!stream.mismatch.empty()) json["mismatch"] = stream.mismatch;
  if (!recording_.empty()) json["recording"] = recording_;
  json["sinks"] = nlohmann::ordered_json::array();
  for (const auto& sink : sinks_->all()) json["sinks"].push_back(sink_json(*sink));
  return json;
}

/// Prints a line; if its reader is gone, ends the run as an interrupt does.
void StreamSession::print_line(const std::string& line) {
  std::fputs((line + '\n').c_str(), stdout);
  if (std::fflush(stdout) == 0 || errno != EPIPE) return;
  quit_ = true;
  [[maybe_unused]] const std::FILE* const nowhere = std::freopen("/dev/null", "w", stdout);
}

/// A line of JSON, or on a terminal a line that each report draws anew.
void StreamSession::show(const HealthReport& health) {
  if (options_.summary) return;
  if (options_.json) {
    return print_line(json_text({{"health", health_json(health)}}));
  }
  if (options_.quiet || isatty(STDERR_FILENO) != 1) return;
  const StreamHealth& stream = health.stream;
  const std::string state = health.since_frame_s > 1
                                ? fmt::format("no frames for {:.0f} s", health.since_frame_s)
                                : fmt::format("{:.0f} Hz", stream.rate_hz);
  fmt::print(
      stderr,
      "\r\033[K{}{}  solved {}  lost {}  incomplete {}  invalid {}  latency {:.2f} ms, worst "
      "{:.2f}  contacts {}  sensels dead {}, stuck {}, drifting {}",
      state, paused_ ? ", paused" : "", grouped(health.solved), stream.lost, stream.incomplete,
      stream.invalid, health.latency_ms_median, health.latency_ms_worst, contacts_, health.dead,
      health.stuck, health.drifting);
  std::fflush(stderr);
  line_drawn_ = true;
}

std::string StreamSession::obey(std::uint64_t client, std::string_view line) {
  const std::vector<std::string> words = words_of(line);
  if (words.empty()) return "";
  const std::string& verb = words.front();
  if (verb == "tare") return start_tare(client, words);
  if (verb == "record") return record(client, rest_of(line, verb));
  if (words.size() == 1) {
    if (verb == "pause" || verb == "resume") {
      paused_ = verb == "pause";
      return done_line(verb);
    }
    if (verb == "health") return json_text({{"ok", true}, {"health", health_json(health())}});
    if (verb == "quit") {
      quit_ = true;
      return done_line(verb);
    }
  }
  return failed_line(
      fmt::format("'{}' is no control line; there are: tare [SECONDS] [preloaded], pause, resume, "
                  "record FILE, record stop, health, quit",
                  printable(line)));
}

std::string StreamSession::start_tare(std::uint64_t client, const std::vector<std::string>& words) {
  double seconds = kTareSeconds;
  bool preloaded = false;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word == "preloaded") {
      preloaded = true;
      continue;
    }
    const auto [end, status] = std::from_chars(word.data(), word.data() + word.size(), seconds);
    if (status != std::errc() || end != word.data() + word.size() ||
        !(seconds > 0 && seconds <= kMostTareSeconds)) {
      return failed_line(fmt::format("tare: '{}' is no duration; give above 0 to {:g} seconds",
                                     printable(word), kMostTareSeconds));
    }
  }
  if (tare_.is_running()) return failed_line("tare: one is being measured; wait for it");
  tare_.start(nanoseconds_of(seconds), preloaded);
  tare_client_ = client;
  return "";  // take_tare() answers.
}

std::string StreamSession::record(std::uint64_t client, const std::string& file) {
  if (file.empty()) return failed_line("record: give a file, or stop");
  try {
    if (file == "stop") {
      if (recording_.empty()) return failed_line("record: nothing is being recorded");
      sinks_->finish_later(std::exchange(recording_, ""), client);
      return "";  // answer_finished() answers.
    }
    if (!recording_.empty()) {
      return failed_line(fmt::format("record: {} is being recorded; give 'record stop' first",
                                     printable(recording_)));
    }
    check_outputs(files_read(options_), {{file, OutputKind::recording}}, options_.replace);
    sinks_->add(create_live_recording(file, info_));
    recording_ = file;
    recording_awaits_tare_ = tare_.is_running() || !has_tare(info_);
    return done_line("record");
  } catch (const Error& error) {
    return failed_line(error.what());
  }
}

void StreamSession::print_summary_json() {
  const auto quantile = [&](double fraction) -> nlohmann::ordered_json {
    const auto ms = all_latencies_.quantile_ms(fraction);
    return ms ? nlohmann::ordered_json(*ms) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json = health_json(last_health_);
  json["source"] = options_.source;
  json["device"] = processor_.device().info().name;
  json["pillars"] = plan_.skin.pillars();
  if (options_.rate_hz) json["missed"] = missed_;
  json["latency_ms"] = {{"median", quantile(0.5)},
                        {"p99", quantile(0.99)},
                        {"p99_9", quantile(0.999)},
                        {"worst", all_latencies_.worst_ms()}};
  fmt::print("{}\n", json_text({{"summary", json}}));
}

void StreamSession::print_summary() {
  if (options_.summary) all_latencies_.add_lost(last_health_.stream.lost);
  if (options_.json) return print_summary_json();
  if (options_.quiet) return;
  const auto quantile = [&](double fraction) {
    const auto ms = all_latencies_.quantile_ms(fraction);
    return ms ? fmt::format("{:.3f} ms", *ms) : "never";
  };
  const StreamHealth& stream = last_health_.stream;
  const double seconds = seconds_of(Clock::now() - start_);
  fmt::print("Solved {} of {} x {} pillars from {} in {:.1f} s on {}\n", counted(solved_, "frame"),
             plan_.skin.pillar_rows(), plan_.skin.pillar_cols(), printable(options_.source),
             seconds, processor_.device().info().name);
  if (solved_ > 0) {
    fmt::print("  latency    median {}, 99 % {}, 99.9 % {}, worst {:.3f} ms\n", quantile(0.5),
               quantile(0.99), quantile(0.999), all_latencies_.worst_ms());
  }
  if (options_.summary) {
    fmt::print("  late       {} solved more than a period of {:.3f} ms after they came\n",
               counted(missed_, "frame"), 1e3 / *options_.rate_hz);
  }
  fmt::print(
      "  frames     {} lost, {} incomplete; {} packets or ring slots came too fast to be read\n",
      grouped(stream.lost), grouped(stream.incomplete), grouped(stream.overrun));
  fmt::print("  packets    {} late, {} twice, {} out of order, {} invalid\n", grouped(stream.late),
             grouped(stream.duplicates), grouped(stream.reordered), grouped(stream.invalid));
  fmt::print("  sensor     {} restarts, {} clock jumps\n", grouped(stream.restarts),
             grouped(stream.clock_jumps));
  for (const auto& sink : sinks_->all()) {
    const LiveSinkStatistics statistics = sink->statistics();
    fmt::print("  {}: {} written, {} dropped\n", printable(sink->name()),
               counted(statistics.frames, "frame"), grouped(statistics.dropped));
  }
}

}  // namespace pillarfield::cli
