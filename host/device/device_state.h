#pragma once

#include <map>
#include <mutex>
#include <string>

#include "device/opencl.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// Context of a device, and the programs built for it by their source.
struct Device::State {
  State(DeviceInfo described, cl::Device opened);

  /// The program of this source, built at most once. Thread-safe. Throws Error with the compiler's
  /// log.
  cl::Program program(const std::string& source);

  const DeviceInfo info;
  const cl::Device device;
  const cl::Context context;

 private:
  std::mutex building_;
  std::map<std::string, cl::Program> programs_;
};

/// A device and its description.
struct Candidate {
  DeviceInfo info;
  cl::Device device;
};

/// All devices of all platforms; DeviceInfo::index is the index in this list.
std::vector<Candidate> all_devices();

}  // namespace pillarfield
