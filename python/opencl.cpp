#include "python/opencl.h"

#include <unistd.h>

#include <atomic>
#include <map>
#include <mutex>

#include "pillarfield/error.h"

namespace pillarfield::python {
namespace {

std::atomic<pid_t> opencl_process{0};

}  // namespace

bool is_forked() {
  const pid_t process = opencl_process;
  return process != 0 && process != getpid();
}

void require_opencl_process() {
  if (!is_forked()) return;
  throw Error("device", "this process was forked after it opened OpenCL",
              "start it with multiprocessing's 'spawn' or 'forkserver', or fork before solving");
}

Device device_named(const std::string& name) {
  require_opencl_process();
  // Never destroyed: drivers may end before static objects do.
  static auto& opened = *new std::map<std::string, Device>;
  static auto& alone = *new std::mutex;
  const std::lock_guard lock(alone);
  if (const auto found = opened.find(name); found != opened.end()) return found->second;
  opencl_process = getpid();
  return opened.emplace(name, open_device(name)).first->second;
}

}  // namespace pillarfield::python
