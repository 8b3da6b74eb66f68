#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.h"
#include "cli/stream/control.h"
#include "cli/stream/run_cost.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/live_session.h"

namespace pillarfield::cli {

/// The files that a stream reads, which it never writes; empty paths among them.
[[nodiscard]] std::vector<std::filesystem::path> files_read(const StreamOptions& options);

[[nodiscard]] std::chrono::nanoseconds nanoseconds_of(double seconds);

/// A run of `pillarfield stream`: a LiveSession, its limits, control lines and reports of health.
class StreamSession {
 public:
  /// All arguments must outlive the session. `info` has contacts.
  StreamSession(const StreamOptions& options, FrameStream& source, const SolverPlan& plan,
                Processor& processor, const LiveSinkInfo& info);

  /// Runs until the source ends, a limit of the options is reached, `quit` or an interrupt; then
  /// completes the sinks. StreamOptions::seconds began when the source was opened, `waited` ago.
  void run(std::chrono::nanoseconds waited);

  void print_summary() const;

 private:
  using Clock = std::chrono::steady_clock;

  bool should_stop();
  void count(const SolvedFrame& frame);
  void tell_events();
  void tell_tare(const LiveEvent& event);
  void tell_of_sinks();
  void tell_failure(const std::string& sink, const std::string& failure);
  void report_health();
  [[nodiscard]] nlohmann::ordered_json health_json(const HealthReport& health) const;
  void show(const HealthReport& health);
  void print_line(const std::string& line);
  void print_summary_json() const;

  std::string obey(std::uint64_t client, std::string_view line);
  std::string start_tare(std::uint64_t client, const std::vector<std::string>& words);
  std::string record(std::uint64_t client, const std::string& file);

  const StreamOptions& options_;
  const Skin skin_;
  const std::string device_;
  ContactTracker tracker_;
  LiveSession live_;
  ControlChannel control_;
  bool quit_ = false;
  std::string refused_;         ///< reason that there is no tare of --tare
  std::uint64_t contacts_ = 0;  ///< in the last frame
  std::uint64_t missed_ = 0;    ///< frames solved later than a period after they came
  RunCost cost_;
  Clock::time_point start_;
  Clock::time_point next_report_;
  HealthReport last_health_;
  std::vector<std::string> failed_;   ///< sinks whose failure was told
  std::vector<std::string> noticed_;  ///< sinks whose notice was told
  bool line_drawn_ = false;
  bool mismatch_told_ = false;
  bool coverage_told_ = false;
};

}  // namespace pillarfield::cli
