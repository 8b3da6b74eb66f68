#pragma once

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Opens a window on the source and stays until it is closed. Returns the exit status. Throws Error
/// where there is no display, no device, or the source cannot be opened or read.
[[nodiscard]] int run_window(const Options& options);

}  // namespace pillarfield::viewer
