#pragma once

#include <optional>
#include <string>

#include "cli/live_run.h"
#include "cli/process_usage.h"
#include "cli/region_count.h"
#include "pillarfield/processor.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

/// What the system said to --realtime.
struct RealtimeAnswer {
  std::string scheduling_refused;  ///< why; empty where it was granted
  std::string memory_refused;      ///< as well
};

/// What there is to say of a live run.
struct LiveReport {
  std::string source;
  LiveSchedule schedule;
  Nanoseconds deadline{0};
  int frames_in_flight = 1;
  std::uint64_t frames_loaded = 0;
  std::uint64_t frames_in_source = 0;
  std::optional<RealtimeAnswer> realtime;  ///< unset where it was not asked for
  LiveResult result;
  ProcessUsage usage;      ///< during the run
  RegionCount last_frame;  ///< of the last frame solved
};

/// How many frames came later than their deadline or never.
[[nodiscard]] std::uint64_t failures(const LiveReport& report);

void print_live_json(const LiveReport& report, const SolverPlan& plan, const Processor& processor);
void print_live_text(const LiveReport& report, const SolverPlan& plan, const Processor& processor);

}  // namespace pillarfield::cli
