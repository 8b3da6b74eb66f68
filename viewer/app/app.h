#pragma once

#include <exception>

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Shows the source in a window until that is closed. Returns the exit status. Throws Error without
/// display or device, and where the source cannot be opened or read.
[[nodiscard]] int run_window(const Options& options);

/// Renders without a window and writes the files of the options. Throws Error.
void run_headless(const Options& options);

/// True if `error` reports a lost graphics device.
[[nodiscard]] bool is_device_lost(const std::exception& error);

}  // namespace pillarfield::viewer
