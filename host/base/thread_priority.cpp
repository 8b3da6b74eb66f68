#include "base/thread_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace pillarfield {

void yield_to_other_threads() {
  constexpr int kNiceness = 5;
  // Linux keeps a niceness for each thread. Only a raise may be refused.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
}

}  // namespace pillarfield
