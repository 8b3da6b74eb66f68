#include "cli/realtime.h"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <system_error>

namespace pillarfield::cli {
namespace {

/// Above common threads, below those of the system, which often have 50.
constexpr int kPriority = 10;

std::string refusal(int status) {
  return status == 0 ? "" : std::generic_category().message(errno);
}

}  // namespace

std::string ask_for_realtime() {
  const sched_param parameters = {.sched_priority = kPriority};
  return refusal(sched_setscheduler(0, SCHED_FIFO, &parameters));
}

std::string ask_for_locked_memory() { return refusal(mlockall(MCL_CURRENT)); }

}  // namespace pillarfield::cli
