#pragma once

#include <map>
#include <mutex>
#include <string>

#include "device/opencl.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// An open device: its context and the programs built for it, by their source.
struct Device::State {
  State(DeviceInfo described, cl::Device opened);

  /// The program of this source, built at most once for the device. May be called from several
  /// threads. Throws Error with the compiler's log.
  cl::Program program(const std::string& source);

  const DeviceInfo info;
  const cl::Device device;
  const cl::Context context;

 private:
  std::mutex building_;
  std::map<std::string, cl::Program> programs_;
};

/// A device and what is known of it.
struct Candidate {
  DeviceInfo info;
  cl::Device device;
};

/// Every device of every platform, in the order of the platforms; DeviceInfo::index counts them.
std::vector<Candidate> all_devices();

}  // namespace pillarfield
