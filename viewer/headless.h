#pragma once

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Renders without a window and writes what the options name. Throws Error.
void run_headless(const Options& options);

}  // namespace pillarfield::viewer
