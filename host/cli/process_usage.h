#pragma once

#include <cstdint>

namespace pillarfield::cli {

/// What the process, with all its threads, has used so far.
struct ProcessUsage {
  double cpu_s = 0;                        ///< time on processors, in the program and in the system
  std::uint64_t voluntary_switches = 0;    ///< a thread had to wait
  std::uint64_t involuntary_switches = 0;  ///< a thread had to give way to another
  std::uint64_t minor_page_faults = 0;     ///< served from memory
  std::uint64_t major_page_faults = 0;     ///< served from disk
};

[[nodiscard]] ProcessUsage process_usage();

/// What was used since `before`.
[[nodiscard]] ProcessUsage process_usage_since(const ProcessUsage& before);

}  // namespace pillarfield::cli
