// The choice of a device, and errors where there is none.

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "device/device_race.h"
#include "device/device_state.h"
#include "pillarfield/error.h"
#include "pillarfield/processor.h"
#include "random_plan.h"

namespace pillarfield {
namespace {

std::string message_of(const std::string& wanted) {
  try {
    static_cast<void>(open_device(wanted));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(DeviceChoice, ASuitableDeviceIsOpenedByDefault) {
  const Device device = open_device();
  EXPECT_TRUE(device.info().unsuitable.empty());
  EXPECT_FALSE(device.info().name.empty());
  EXPECT_GE(device.info().lanes, 1);
}

TEST(DeviceChoice, SmallSkinsAreTheHostsUnlessADeviceIsNamed) {
  const auto solver = [](const Device& device, std::uint32_t rows, std::uint32_t cols,
                         SenselType type = SenselType::u8) {
    return device.for_plan(bare_plan(rows, cols, type)).info().type;
  };
  EXPECT_EQ(solver(open_device(), 13, 6), "host");
  EXPECT_EQ(solver(open_device(), 512, 512), "host");
  EXPECT_EQ(solver(open_device(), 256, 256, SenselType::f32), "host");
  EXPECT_EQ(solver(open_device(), 256, 2), "host");
  EXPECT_EQ(solver(open_device("host"), 512, 514), "host");
  EXPECT_NE(solver(open_device("opencl"), 13, 6), "host");
  if (!open_device("opencl").info().shares_memory) return;  // The quicker one takes them.
  EXPECT_NE(solver(open_device(), 512, 514), "host");
  EXPECT_NE(solver(open_device(), 256, 258, SenselType::f32), "host") << "not in whole numbers";
}

TEST(DeviceChoice, GpusComeBeforeCpus) {
  bool has_gpu = false;
  for (const DeviceInfo& device : list_devices()) {
    has_gpu = has_gpu || (device.type == "GPU" && device.unsuitable.empty());
  }
  EXPECT_EQ(open_device().info().type == "GPU", has_gpu);
}

TEST(DeviceChoice, TheTimeOfAFrameIsMeasuredOnEachDevice) {
  for (const char* const name : {"opencl", "host"}) {
    for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
      const double seconds = time_of_frame(open_device(name), bare_plan(64, 94, type));
      EXPECT_GT(seconds, 0);
      EXPECT_LT(seconds, 10);
    }
  }
}

TEST(DeviceChoice, ByIndexAndByPartOfTheNameInAnyCase) {
  for (const DeviceInfo& listed : list_devices()) {
    if (!listed.unsuitable.empty()) continue;
    EXPECT_EQ(open_device(std::to_string(listed.index)).info().index, listed.index);
    std::string shouted = listed.name.substr(0, 5);
    for (char& character : shouted) character = static_cast<char>(std::toupper(character));
    EXPECT_NE(open_device(shouted).info().name.find(listed.name.substr(0, 5)), std::string::npos);
  }
}

TEST(DeviceChoice, AnUnknownDeviceIsAnErrorThatListsAll) {
  for (const std::string wanted : {"no such device", "999", "-1"}) {
    const std::string message = message_of(wanted);
    EXPECT_NE(message.find(wanted), std::string::npos) << message;
    for (const DeviceInfo& device : list_devices()) {
      EXPECT_NE(message.find(device.name), std::string::npos) << message;
    }
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(Programs, AreBuiltOncePerDeviceAndSource) {
  const Device device = open_device();
  const std::string source = "kernel void nothing(global int* value) { *value = 1; }";
  const cl::Program first = device.state().program(source);
  EXPECT_EQ(first(), device.state().program(source)());
  EXPECT_NE(first(), device.state().program(source + "\n")());
}

TEST(Programs, ThatDoNotCompileHaveALog) {
  try {
    open_device().state().program("kernel void broken() { undeclared = 1; }");
    FAIL() << "it compiled";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("undeclared"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace pillarfield
