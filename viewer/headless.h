#pragma once

#include "viewer/options.h"

namespace pillarfield::viewer {

/// Renders without a window and writes the files of the options. Throws Error.
void run_headless(const Options& options);

}  // namespace pillarfield::viewer
