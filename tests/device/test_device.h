#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <string>

#include "pillarfield/processor.h"

namespace pillarfield {

/// One device for all tests of a program, so that kernels are compiled once: that of the
/// environment variable PILLARFIELD_TEST_DEVICE, or the best OpenCL device. It is closed before the
/// process ends: drivers must not be called while their statics are destroyed.
class DeviceForTests : public testing::Environment {
 public:
  void SetUp() override {
    const char* const wanted = std::getenv("PILLARFIELD_TEST_DEVICE");
    device = open_device(wanted != nullptr ? wanted : "opencl");
  }
  void TearDown() override { device.reset(); }
  static inline std::optional<Device> device;
};

inline const testing::Environment* const kDeviceForTests =
    testing::AddGlobalTestEnvironment(new DeviceForTests);

inline const Device& test_device() { return DeviceForTests::device.value(); }

/// The lanes to test for a path of `lanes`. A GPU runs the single lane that users get there:
/// sixteen lanes failed the tolerance of the paper's estimator on NVIDIA's driver, while its
/// largest ratio was a quotient (docs/derivations/paper_solve.md).
inline int tested_lanes(int lanes) { return test_device().info().lanes == 1 ? 1 : lanes; }

/// A way of frames through a device.
struct DevicePath {
  SenselType type;
  int lanes;
  Memory memory;
};

inline std::string name_of_path(const testing::TestParamInfo<DevicePath>& path) {
  return std::string(name_of(path.param.type)) + "_lanes" + std::to_string(path.param.lanes) +
         (path.param.memory == Memory::shared ? "_shared" : "_staged");
}

inline Memory memory_of(Memory memory) { return memory; }
template <class Path>
Memory memory_of(const Path& path) {
  return path.memory;
}

/// Tests of a path, or of a memory, which skip memory that the device does not share.
template <class Path>
class OnDevice : public testing::TestWithParam<Path> {
 protected:
  void SetUp() override {
    if (memory_of(this->GetParam()) == Memory::shared && !test_device().info().shares_memory) {
      GTEST_SKIP() << "this device does not share the host's memory";
    }
  }
};

}  // namespace pillarfield
