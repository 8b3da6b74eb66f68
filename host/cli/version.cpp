// pillarfield --version: build and libraries.

#include "pillarfield/version.h"

#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/commit.h"
#include "cli/json_text.h"
#include "pillarfield/error.h"

namespace pillarfield::cli {

void print_version(bool json) {
  nlohmann::ordered_json opencl = nlohmann::ordered_json::array();
  std::string no_opencl = "no device";
  try {
    for (const DeviceInfo& device : list_devices()) {
      opencl.push_back(
          {{"device", device.name}, {"platform", device.platform}, {"version", device.version}});
    }
  } catch (const Error& error) {
    no_opencl = error.what();
  }
  if (json) {
    fmt::print("{}\n", json_text({{"version", kVersion},
                                  {"commit", kCommit},
                                  {"compiler", PILLARFIELD_COMPILER},
                                  {"build_type", PILLARFIELD_BUILD_TYPE},
                                  {"hdf5", hdf5_version()},
                                  {"opencl", opencl}}));
    return;
  }
  fmt::print("pillarfield {}\ncommit    {}\nbuild     {}, {}\nHDF5      {}\n", kVersion, kCommit,
             PILLARFIELD_COMPILER, PILLARFIELD_BUILD_TYPE, hdf5_version());
  if (opencl.empty()) fmt::print("OpenCL    {}\n", no_opencl);
  for (const auto& device : opencl) {
    fmt::print("OpenCL    {}: {}\n", device["device"].get<std::string>(),
               device["version"].get<std::string>());
  }
}

}  // namespace pillarfield::cli
