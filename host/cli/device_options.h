#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "pillarfield/processor.h"

namespace pillarfield::cli {

/// Where the work is done.
struct DeviceOptions {
  std::string name;  ///< for open_device
  Memory memory = Memory::automatic;
};

/// --device and --memory.
void add_device_options(CLI::App& command, DeviceOptions& options);

}  // namespace pillarfield::cli
