#include "cli/process_usage.h"

#include <sys/resource.h>

namespace pillarfield::cli {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProcessUsage process_usage() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime),
          .voluntary_switches = static_cast<std::uint64_t>(usage.ru_nvcsw),
          .involuntary_switches = static_cast<std::uint64_t>(usage.ru_nivcsw),
          .minor_page_faults = static_cast<std::uint64_t>(usage.ru_minflt),
          .major_page_faults = static_cast<std::uint64_t>(usage.ru_majflt)};
}

ProcessUsage process_usage_since(const ProcessUsage& before) {
  const ProcessUsage now = process_usage();
  return {.cpu_s = now.cpu_s - before.cpu_s,
          .voluntary_switches = now.voluntary_switches - before.voluntary_switches,
          .involuntary_switches = now.involuntary_switches - before.involuntary_switches,
          .minor_page_faults = now.minor_page_faults - before.minor_page_faults,
          .major_page_faults = now.major_page_faults - before.major_page_faults};
}

}  // namespace pillarfield::cli
