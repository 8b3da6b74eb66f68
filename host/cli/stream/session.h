#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/stream/control.h"
#include "cli/stream/latency_histogram.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/live.h"
#include "pillarfield/live_tare.h"
#include "pillarfield/pipeline.h"
#include "pillarfield/processor.h"
#include "pillarfield/sensel_watch.h"

namespace pillarfield::cli {

/// The files that a stream reads, which it never writes; empty paths among them.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const StreamOptions& options);

/// A run of `pillarfield stream`: frames of a source through the solver to live sinks, with control
/// lines, live tare, pause, recording and reports of health.
class StreamSession {
 public:
  /// All arguments must outlive the session.
  StreamSession(const StreamOptions& options, FrameStream& source, const SolverPlan& plan,
                Processor& processor, LiveSinkInfo info);
  ~StreamSession();
  StreamSession(const StreamSession&) = delete;
  StreamSession& operator=(const StreamSession&) = delete;

  /// Runs until the source ends, a limit of the options is reached, `quit` or an interrupt; then
  /// completes the sinks.
  void run();

  void print_summary();

 private:
  class Source;
  class Sinks;
  using Clock = std::chrono::steady_clock;

  bool should_stop();
  void take_tare(const FrameView& frame, std::chrono::nanoseconds arrived);
  [[nodiscard]] std::string pass_tare_on(const std::vector<float>& tare);
  void answer_finished();
  void report_health();
  [[nodiscard]] HealthReport health() const;
  [[nodiscard]] nlohmann::ordered_json health_json(const HealthReport& health) const;
  void print_summary_json();
  void show(const HealthReport& health);
  void print_line(const std::string& line);

  std::string obey(std::uint64_t client, std::string_view line);
  std::string start_tare(std::uint64_t client, const std::vector<std::string>& words);
  std::string record(std::uint64_t client, const std::string& file);

  const StreamOptions& options_;
  SolverPlan plan_;
  Processor& processor_;
  LiveSinkInfo info_;
  ContactTracker tracker_;
  LiveTare tare_;
  SenselWatch watch_;
  std::unique_ptr<Source> source_;
  std::unique_ptr<Sinks> sinks_;
  ControlChannel control_;
  std::uint64_t tare_client_ = 0;
  std::string recording_;               ///< file being recorded; empty: none
  bool recording_awaits_tare_ = false;  ///< the next tare is that of its frames
  bool paused_ = false;
  bool quit_ = false;
  std::uint64_t received_ = 0;
  std::uint64_t solved_ = 0;
  std::uint64_t missed_ = 0;    ///< frames solved later than a period after they came
  std::uint64_t contacts_ = 0;  ///< in the last frame
  LatencyHistogram all_latencies_;
  LatencyHistogram recent_latencies_;
  Clock::time_point start_;
  Clock::time_point last_arrival_;
  Clock::time_point last_report_;
  Clock::time_point next_report_;
  std::uint64_t received_at_report_ = 0;
  double replay_hz_ = 0;  ///< over the last report
  HealthReport last_health_;
  bool line_drawn_ = false;
  bool mismatch_told_ = false;
};

}  // namespace pillarfield::cli
