#pragma once

#include <optional>
#include <string>

#include "cli/pace/latencies.h"
#include "cli/pace/process.h"
#include "cli/region_count.h"
#include "pillarfield/processor.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

struct PaceSchedule {
  double rate_hz = 1000;
  std::uint64_t frames = 0;
  std::uint64_t backlog_frames = 4;  ///< a frame that is late by more periods is dropped
  Nanoseconds spin{0};               ///< busy part of each wait
};

/// Reasons why the system refused --realtime; empty where it was granted.
struct RealtimeRefusals {
  std::string scheduling;
  std::string memory;
};

/// Setup and outcome of a run.
struct PaceReport {
  std::string source;
  PaceSchedule schedule;
  Nanoseconds deadline{0};
  int frames_in_flight = 1;
  std::uint64_t frames_loaded = 0;
  std::uint64_t frames_in_source = 0;
  std::optional<RealtimeRefusals> realtime;  ///< set with --realtime
  PaceResult result;
  ProcessUsage usage;      ///< during the run
  RegionCount last_frame;  ///< of the last solved frame
};

/// Counts the dropped frames and those later than the deadline.
[[nodiscard]] std::uint64_t failures(const PaceReport& report);

void print_pace_json(const PaceReport& report, const SolverPlan& plan, const Processor& processor);
void print_pace_text(const PaceReport& report, const SolverPlan& plan, const Processor& processor);

}  // namespace pillarfield::cli
