#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "device/opencl.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// Context of an OpenCL device, and the programs built for it by their source; or the host.
struct Device::State {
  State(DeviceInfo described, cl::Device opened);
  /// The host without OpenCL.
  State();

  [[nodiscard]] bool is_host() const { return context() == nullptr; }

  /// The program of this source, built at most once. Thread-safe. Throws Error with the compiler's
  /// log.
  cl::Program program(const std::string& source);

  const DeviceInfo info;
  const cl::Device device;    ///< null: the host
  const cl::Context context;  ///< null: the host

 private:
  std::mutex building_;
  std::map<std::string, cl::Program> programs_;
};

/// The best device, which is opened when it is first needed.
class Device::Best {
 public:
  /// An OpenCL device; the host if there is none. Thread-safe.
  std::shared_ptr<State> opened();

 private:
  std::mutex opening_;
  std::shared_ptr<State> state_;
};

/// A device and its description.
struct Candidate {
  DeviceInfo info;
  cl::Device device;
};

/// All devices of all platforms; DeviceInfo::index is the index in this list.
std::vector<Candidate> all_devices();

}  // namespace pillarfield
