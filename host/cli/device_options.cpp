#include "cli/device_options.h"

#include <map>

namespace pillarfield::cli {

void add_device_options(CLI::App& command, DeviceOptions& options) {
  static const std::map<std::string, Memory> memories = {
      {"auto", Memory::automatic}, {"shared", Memory::shared}, {"staged", Memory::staged}};
  command.add_option("--device", options.name,
                     "OpenCL device, by index or part of its name [the best]; see info --devices");
  command
      .add_option("--memory", options.memory,
                  "auto, shared (zero copy) or staged (copied to the device) [auto]")
      ->transform(CLI::Transformer(memories).description(""));
}

}  // namespace pillarfield::cli
