#include "cli/device_options.h"

#include "cli/choice.h"

namespace pillarfield::cli {

void add_device_options(CLI::App& command, DeviceOptions& options) {
  command.add_option("--device", options.name,
                     "OpenCL device, by index or part of its name [the best]; see info --devices");
  add_choice<Memory>(
      command, "--memory", options.memory,
      {{"auto", Memory::automatic}, {"shared", Memory::shared}, {"staged", Memory::staged}},
      "auto, shared (zero copy) or staged (copied to the device) [auto]");
}

}  // namespace pillarfield::cli
