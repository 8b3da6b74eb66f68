#include "python/process.h"

#include <atomic>
#include <map>
#include <mutex>

#include "pillarfield/error.h"

namespace pillarfield::python {

void throw_foreign(const std::string& what) {
  throw Error(what, "it belongs to the process that this one was forked from",
              "make one here, on device=\"host\"; or start the process with multiprocessing's "
              "'spawn' or 'forkserver'");
}

Device device_named(const std::string& name) {
  static std::atomic<pid_t> process{0};
  pid_t before = 0;
  if (!process.compare_exchange_strong(before, getpid()) && before != getpid()) {
    if (name == "host") return open_device(name);  // It has no threads, and needs no lock.
    throw_foreign("the OpenCL device");
  }
  // Never destroyed: drivers may end before static objects do.
  static auto& opened = *new std::map<std::string, Device>;
  static auto& alone = *new std::mutex;
  const std::lock_guard lock(alone);
  if (const auto found = opened.find(name); found != opened.end()) return found->second;
  return opened.emplace(name, open_device(name)).first->second;
}

}  // namespace pillarfield::python
