#pragma once

#include <cstdint>
#include <string>

/// Resources and privileges of this process.
namespace pillarfield::cli {

/// Resources used by all threads of the process.
struct ProcessUsage {
  double cpu_s = 0;                        ///< user and system time
  std::uint64_t voluntary_switches = 0;    ///< a thread had to wait
  std::uint64_t involuntary_switches = 0;  ///< a thread was preempted
  std::uint64_t minor_page_faults = 0;     ///< served from memory
  std::uint64_t major_page_faults = 0;     ///< served from disk
};

/// Returns the usage since `before`; by default since the process started.
[[nodiscard]] ProcessUsage process_usage_since(const ProcessUsage& before = {});

/// Requests real-time scheduling (SCHED_FIFO) for this thread and those that it starts later.
/// Returns the reason of a refusal, or an empty text.
[[nodiscard]] std::string request_realtime();

/// Locks the current memory of the process. Returns as request_realtime().
[[nodiscard]] std::string request_locked_memory();

}  // namespace pillarfield::cli
