#include <fmt/format.h>

#include "device/device_state.h"
#include "device/kernel_cache.h"

namespace pillarfield {

Device::State::State(DeviceInfo described, cl::Device opened)
    : info(std::move(described)), device(std::move(opened)), context(device) {}

cl::Program Device::State::program(const std::string& source) {
  const std::scoped_lock lock(building_);
  if (const auto found = programs_.find(source); found != programs_.end()) return found->second;
  if (std::string refused = reason_not_to_compile(info); !refused.empty()) {
    throw Error(info.name, "compiled kernels cannot be written", refused);
  }
  cl::Program built(context, source);
  try {
    built.build(device, "-cl-std=CL1.2 -w");  // PoCL would print how many warnings there are.
  } catch (const cl::BuildError& error) {
    const auto log = error.getBuildLog();
    throw Error(info.name, "the kernel does not compile on this device",
                fmt::format("choose another device; the compiler says: {}",
                            log.empty() ? "nothing" : log.front().second));
  }
  return programs_.emplace(source, std::move(built)).first->second;
}

const DeviceInfo& Device::info() const { return state_->info; }

}  // namespace pillarfield
