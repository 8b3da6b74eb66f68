#include "cli/pace/process.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <system_error>

namespace pillarfield::cli {
namespace {

/// Above ordinary threads, below those of the system, which often have 50.
constexpr int kPriority = 10;

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

std::string refusal(int status) {
  return status == 0 ? "" : std::generic_category().message(errno);
}

}  // namespace

ProcessUsage process_usage_since(const ProcessUsage& before) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto since = [](long now, std::uint64_t then) {
    return static_cast<std::uint64_t>(now) - then;
  };
  return {.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime) - before.cpu_s,
          .voluntary_switches = since(usage.ru_nvcsw, before.voluntary_switches),
          .involuntary_switches = since(usage.ru_nivcsw, before.involuntary_switches),
          .minor_page_faults = since(usage.ru_minflt, before.minor_page_faults),
          .major_page_faults = since(usage.ru_majflt, before.major_page_faults)};
}

std::string request_realtime() {
  const sched_param parameters = {.sched_priority = kPriority};
  return refusal(sched_setscheduler(0, SCHED_FIFO, &parameters));
}

std::string request_locked_memory() { return refusal(mlockall(MCL_CURRENT)); }

}  // namespace pillarfield::cli
