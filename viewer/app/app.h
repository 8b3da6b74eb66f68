#pragma once

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Shows the source in a window until that is closed. Returns the exit status. Throws Error without
/// display or device, and where the source cannot be opened or read.
[[nodiscard]] int run_window(const Options& options);

}  // namespace pillarfield::viewer
