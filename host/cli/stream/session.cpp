#include "cli/stream/session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <sstream>
#include <utility>

#include "base/number_text.h"
#include "cli/json_text.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/printable.h"
#include "streams/message/health_json.h"

namespace pillarfield::cli {
namespace {

constexpr double kTareSeconds = 0.5;
constexpr double kMostTareSeconds = 60;

double seconds_of(std::chrono::nanoseconds time) {
  return 1e-9 * static_cast<double>(time.count());
}

std::vector<std::string> words_of(std::string_view line) {
  std::istringstream text{std::string(line)};
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

/// The rest of a line after a word, without blanks around it.
std::string rest_of(std::string_view line, const std::string& word) {
  line.remove_prefix(line.find(word) + word.size());
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  return std::string(line.substr(0, line.find_last_not_of(" \t") + 1));
}

std::string done_line(const std::string& what) { return json_text({{"ok", true}, {"done", what}}); }

std::string failed_line(const std::string& why) {
  return json_text({{"ok", false}, {"error", why}});
}

/// Prints where a page or Foxglove finds a server.
void tell_address(const std::string& sink) {
  constexpr std::string_view kFoxglove = "foxglove:";
  if (sink.starts_with("http://")) fmt::print(stderr, "Open {} in a browser\n", printable(sink));
  if (!sink.starts_with(kFoxglove)) return;
  fmt::print(stderr, "Open ws://{} in Foxglove\n", printable(sink.substr(kFoxglove.size())));
}

nlohmann::ordered_json sink_json(const LiveSession::Sink& sink) {
  const LiveSinkStatistics& statistics = sink.statistics;
  nlohmann::ordered_json json = {{"name", sink.name},
                                 {"frames", statistics.frames},
                                 {"dropped", statistics.dropped},
                                 {"clients", statistics.clients},
                                 {"refused", statistics.refused}};
  if (!statistics.failure.empty()) json["failure"] = statistics.failure;
  if (!statistics.notice.empty()) json["notice"] = statistics.notice;
  return json;
}

}  // namespace

std::chrono::nanoseconds nanoseconds_of(double seconds) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * seconds));
}

StreamSession::StreamSession(const StreamOptions& options, FrameStream& source,
                             const SolverPlan& plan, Processor& processor, const LiveSinkInfo& info)
    : options_(options),
      skin_(plan.skin),
      device_(info.forces.device),
      tracker_(plan.skin.element_pitch_mm(), *info.forces.contacts),
      live_(source, plan, processor, info, options.plan.settings.threshold_counts.has_value()),
      control_(options.control),
      cost_(plan) {
  for (const std::string& target : options.sinks) live_.add(create_live_sink(target, info));
  if (!options.relay.empty()) live_.add(create_live_relay(options.relay, info));
  for (const LiveSession::Sink& sink : live_.sinks()) {
    if (!options.quiet) tell_address(sink.name);
  }
  if (options.tare_s > 0) live_.start_tare(nanoseconds_of(options.tare_s), false, 0, true);
  if (!options.record.empty()) live_.record(options.record);
}

void StreamSession::run(std::chrono::nanoseconds waited) {
  start_ = Clock::now() - waited;
  next_report_ = Clock::now() + nanoseconds_of(options_.health_interval_s);
  const auto counter = callback_sink([this](const SolvedFrame& frame) { count(frame); });
  live_.run({.frames_in_flight = options_.frames_in_flight,
             .contacts = &tracker_,
             .frames = options_.frames,
             .sink = counter.get(),
             .stop = [this] { return should_stop(); }});
  report_health();
  if (line_drawn_) fmt::print(stderr, "\n");
  live_.finish();
  tell_events();
  tell_of_sinks();
  if (refused_.empty() && options_.tare_s > 0 && live_.is_taring()) {
    refused_ = "the frames ended before it was measured; give a shorter --tare";
  }
  if (!refused_.empty()) throw Error("--tare", "no frame was solved: " + refused_);
  if (!failed_.empty()) {
    throw Error(options_.source, "an output failed; see above", "mend it and start again");
  }
}

bool StreamSession::should_stop() {
  control_.poll([this](std::uint64_t client, std::string_view line) { return obey(client, line); });
  tell_events();
  const auto now = Clock::now();
  if (now >= next_report_) report_health();
  return quit_ || is_interrupted() ||
         (options_.seconds && now - start_ >= nanoseconds_of(*options_.seconds)) ||
         (options_.most_idle_s && live_.health().since_frame_s >= *options_.most_idle_s);
}

void StreamSession::count(const SolvedFrame& frame) {
  const auto latency = Clock::now().time_since_epoch() - frame.arrived;
  if (options_.rate_hz && latency > nanoseconds_of(1 / *options_.rate_hz)) ++missed_;
  contacts_ = frame.contacts->contacts.size();
  cost_.count(frame.forces);
}

/// Answers the clients whose tare is measured, or whose recording is complete.
void StreamSession::tell_events() {
  for (const LiveEvent& event : live_.take_events()) {
    if (event.kind == LiveEvent::Kind::tare) {
      tell_tare(event);
      continue;
    }
    tell_failure(event.recording, event.error);
    control_.answer(event.tag,
                    event.error.empty() ? done_line("record stop") : failed_line(event.error));
  }
}

void StreamSession::tell_tare(const LiveEvent& event) {
  if (!event.error.empty()) {
    if (event.tag == 0) {  // of --tare: no frame was solved
      refused_ = event.error;
      quit_ = true;
    }
    return control_.answer(event.tag, failed_line(event.error + ", or insist: tare preloaded"));
  }
  if (event.tag == 0 && !options_.quiet) {
    fmt::print(stderr, "pillarfield: tare taken: {}\n", event.note);
  }
  nlohmann::ordered_json answer = {{"ok", true}, {"done", "tare"}, {"note", event.note}};
  if (!event.recording.empty()) {
    const std::string warning =
        fmt::format("{} keeps the tare of its start; record another file for the new one",
                    printable(event.recording));
    fmt::print(stderr, "pillarfield: {}\n", warning);
    answer["warning"] = warning;
  }
  control_.answer(event.tag, json_text(answer));
}

void StreamSession::tell_failure(const std::string& sink, const std::string& failure) {
  if (failure.empty() || std::ranges::count(failed_, sink) > 0) return;
  failed_.push_back(sink);
  fmt::print(stderr, "pillarfield: {}: {}\n", printable(sink), printable(failure));
}

void StreamSession::tell_of_sinks() {
  for (const auto& [name, statistics] : live_.sinks()) {
    tell_failure(name, statistics.failure);
    if (statistics.notice.empty() || std::ranges::count(noticed_, name) > 0) continue;
    noticed_.push_back(name);
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(name), printable(statistics.notice));
  }
}

void StreamSession::report_health() {
  last_health_ = live_.report();
  cost_.look();
  next_report_ = Clock::now() + nanoseconds_of(options_.health_interval_s);
  tell_of_sinks();
  const auto tell_once = [&](const std::string& words, bool& told) {
    if (words.empty() || std::exchange(told, true)) return;
    fmt::print(stderr, "pillarfield: {}: {}\n", printable(options_.source), words);
  };
  tell_once(last_health_.stream.mismatch, mismatch_told_);
  tell_once(last_health_.coverage, coverage_told_);
  show(last_health_);
}

nlohmann::ordered_json StreamSession::health_json(const HealthReport& health) const {
  nlohmann::ordered_json json = {{"seconds", seconds_of(Clock::now() - start_)}};
  json.update(pillarfield::health_json(health));
  json["contacts"] = contacts_;
  json["paused"] = live_.is_paused();
  const std::string& mismatch = health.stream.mismatch;
  if (!mismatch.empty()) json["mismatch"] = mismatch;
  if (const std::string file = live_.recording(); !file.empty()) json["recording"] = file;
  json["sinks"] = nlohmann::ordered_json::array();
  for (const LiveSession::Sink& sink : live_.sinks()) json["sinks"].push_back(sink_json(sink));
  return json;
}

/// Prints a line; if its reader is gone, ends the run as an interrupt does.
void StreamSession::print_line(const std::string& line) {
  std::fputs((line + '\n').c_str(), stdout);
  if (std::fflush(stdout) == 0 || errno != EPIPE) return;
  quit_ = true;
  [[maybe_unused]] const std::FILE* const nowhere = std::freopen("/dev/null", "w", stdout);
}

/// A line of JSON, or on a terminal a line that each report redraws.
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
      state, live_.is_paused() ? ", paused" : "", grouped(health.solved), stream.lost,
      stream.incomplete, stream.invalid, health.latency_ms_median, health.latency_ms_worst,
      contacts_, health.dead, health.stuck, health.drifting);
  std::fflush(stderr);
  line_drawn_ = true;
}

std::string StreamSession::obey(std::uint64_t client, std::string_view line) {
  const std::vector<std::string> words = words_of(line);
  const std::string verb = words.empty() ? "" : words.front();
  if (verb == "tare") return start_tare(client, words);
  if (verb == "record") return record(client, rest_of(line, verb));
  if (words.size() == 1) {
    if (verb == "pause" || verb == "resume") {
      live_.set_paused(verb == "pause");
      return done_line(verb);
    }
    if (verb == "health") return json_text({{"ok", true}, {"health", health_json(live_.health())}});
    if (verb == "quit") {
      quit_ = true;
      return done_line(verb);
    }
  }
  return failed_line(fmt::format(
      "'{}' is not a control line; there are: tare [SECONDS] [preloaded], pause, resume, "
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
      return failed_line(fmt::format("tare: '{}' is not a duration; give above 0 to {:g} seconds",
                                     printable(word), kMostTareSeconds));
    }
  }
  if (!live_.start_tare(nanoseconds_of(seconds), preloaded, client)) {
    return failed_line("tare: one is being measured; wait for it");
  }
  return "";  // tell_events() answers.
}

std::string StreamSession::record(std::uint64_t client, const std::string& file) {
  if (file.empty()) return failed_line("record: give a file, or stop");
  try {
    if (file == "stop") {
      return live_.stop_recording(client) ? ""  // tell_events() answers.
                                          : failed_line("record: nothing is being recorded");
    }
    check_outputs(files_read(options_), {{file, OutputKind::recording}}, options_.replace);
    live_.record(file);
    return done_line("record");
  } catch (const Error& error) {
    return failed_line(error.what());
  }
}

void StreamSession::print_summary_json() const {
  const std::uint64_t lost = options_.summary ? last_health_.stream.lost : 0;
  const auto latency = [&](double fraction) -> nlohmann::ordered_json {
    const auto ms = live_.latency_ms(fraction, lost);
    return ms ? nlohmann::ordered_json(*ms) : nlohmann::ordered_json(nullptr);
  };
  nlohmann::ordered_json json = health_json(last_health_);
  json["source"] = options_.source;
  json["device"] = device_;
  json["pillars"] = skin_.elements();
  if (options_.rate_hz) json["missed"] = missed_;
  json["latency_ms"] = {{"median", latency(0.5)},
                        {"p99", latency(0.99)},
                        {"p99_9", latency(0.999)},
                        {"worst", live_.worst_latency_ms()}};
  if (options_.summary) json["cost"] = cost_.json();
  fmt::print("{}\n", json_text({{"summary", json}}));
}

void StreamSession::print_summary() const {
  if (options_.json) return print_summary_json();
  if (options_.quiet) return;
  const StreamHealth& stream = last_health_.stream;
  const auto latency = [&](double fraction) {
    const auto ms = live_.latency_ms(fraction, options_.summary ? stream.lost : 0);
    return ms ? fmt::format("{:.3f} ms", *ms) : "never";
  };
  fmt::print("Solved {} of {} x {} {} from {} in {:.1f} s on {}\n",
             counted(last_health_.solved, "frame"), skin_.element_rows(), skin_.element_cols(),
             name_of(skin_.layout), printable(options_.source), seconds_of(Clock::now() - start_),
             device_);
  if (last_health_.solved > 0) {
    fmt::print("  latency    median {}, 99 % {}, 99.9 % {}, worst {:.3f} ms\n", latency(0.5),
               latency(0.99), latency(0.999), live_.worst_latency_ms());
  }
  if (options_.summary) {
    fmt::print("  late       {} solved more than a period of {:.3f} ms after they came\n",
               counted(missed_, "frame"), 1e3 / *options_.rate_hz);
    fmt::print("{}", cost_.text());
  }
  fmt::print(
      "  frames     {} lost, {} incomplete; {} packets or ring slots came too fast to be read\n",
      grouped(stream.lost), grouped(stream.incomplete), grouped(stream.overrun));
  fmt::print("  packets    {} late, {} twice, {} out of order, {} invalid\n", grouped(stream.late),
             grouped(stream.duplicates), grouped(stream.reordered), grouped(stream.invalid));
  fmt::print("  sensor     {} restarts, {} clock jumps\n", grouped(stream.restarts),
             grouped(stream.clock_jumps));
  for (const auto& [name, statistics] : live_.sinks()) {
    fmt::print("  {}: {} written, {} dropped\n", printable(name),
               counted(statistics.frames, "frame"), grouped(statistics.dropped));
  }
}

}  // namespace pillarfield::cli
